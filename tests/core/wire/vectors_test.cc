#include "tests/core/wire/vectors.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "tests/core/wire/json.h"

namespace facewire::wire {
namespace {

const std::filesystem::path kFolder =
    std::filesystem::path(FACEWIRE_SOURCE_DIR) / "tests/core/wire/vectors";

std::string Contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Vectors, TheEncoderStillWritesTheBytesOfTheFiles) {
  for (const Vector& v : AllVectors()) {
    const std::string bytes(reinterpret_cast<const char*>(v.stream.data()), v.stream.size());
    EXPECT_EQ(Contents(kFolder / (v.name + ".bin")), bytes)
        << v.name << ": the protocol is append-only; a vector that was published may not change. "
        << "For a new one: wire_vectors --update tests/core/wire/vectors";
  }
}

TEST(Vectors, TheDecoderStillReadsWhatTheFilesSay) {
  for (const Vector& v : AllVectors()) {
    const std::string bytes = Contents(kFolder / (v.name + ".bin"));
    EXPECT_EQ(Contents(kFolder / (v.name + ".json")),
              DecodeToJson(v.about, std::as_bytes(std::span(bytes))))
        << v.name;
  }
}

TEST(Vectors, EveryFileBelongsToAVectorAndNoNameIsUsedTwice) {
  std::set<std::string> names;
  for (const Vector& v : AllVectors()) EXPECT_TRUE(names.insert(v.name).second) << v.name;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    EXPECT_TRUE(names.contains(entry.path().stem().string())) << entry.path();
  }
}

}  // namespace
}  // namespace facewire::wire
