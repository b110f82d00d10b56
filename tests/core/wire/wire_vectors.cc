// wire_vectors FILE.bin ...   prints what a receiver makes of each stream, as JSON
// wire_vectors --update DIR   writes the vectors into DIR after the protocol or a vector has
// changed
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "tests/core/wire/json.h"
#include "tests/core/wire/vectors.h"

namespace {

using facewire::wire::AllVectors;
using facewire::wire::DecodeToJson;

bool Write(const std::filesystem::path& path, std::string_view text) {
  std::ofstream out(path, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  return static_cast<bool>(out.flush());
}

int Update(const std::filesystem::path& folder) {
  for (const auto& v : AllVectors()) {
    const std::string_view stream(reinterpret_cast<const char*>(v.stream.data()), v.stream.size());
    if (!Write(folder / (v.name + ".bin"), stream) ||
        !Write(folder / (v.name + ".json"), DecodeToJson(v.about, v.stream))) {
      (void)std::fprintf(stderr, "wire_vectors: cannot write %s in %s\n", v.name.c_str(),
                         folder.c_str());
      return 1;
    }
  }
  return 0;
}

int Print(const char* path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    (void)std::fprintf(stderr, "wire_vectors: cannot read %s\n", path);
    return 2;
  }
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  (void)std::fputs(DecodeToJson(path, std::as_bytes(std::span(bytes))).c_str(), stdout);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::string_view(argv[1]) == "--update") return Update(argv[2]);
  if (argc < 2) {
    (void)std::fputs("usage: wire_vectors FILE.bin ... | wire_vectors --update DIR\n", stderr);
    return 2;
  }
  for (int i = 1; i < argc; ++i) {
    if (const int code = Print(argv[i]); code != 0) return code;
  }
  return 0;
}
