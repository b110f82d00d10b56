#include "tools/facewire/rig/gltf_json.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "app/error.h"

namespace facewire::tools::rig {
namespace {

// The container of glTF 2.0, section 4: little-endian words. A header (magic, version, length of
// the file), then chunks (length, kind, bytes).
constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN"
constexpr std::size_t kHeaderSize = 12;
constexpr std::size_t kChunkHeaderSize = 8;

std::uint32_t WordAt(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;) word = (word << 8) | static_cast<unsigned char>(bytes[at + i]);
  return word;
}

struct Container {
  std::string_view json;
  std::string_view binary;
  bool has_binary = false;
};

Container OpenContainer(std::string_view bytes, const std::string& source) {
  const auto bad = [&](const std::string& what) -> app::BadInput {
    return app::BadInput(source + ": " + what);
  };
  if (bytes.size() < kHeaderSize + kChunkHeaderSize)
    throw bad("is cut off after " + std::to_string(bytes.size()) + " bytes");
  if (const std::uint32_t version = WordAt(bytes, 4); version != 2)
    throw bad("is a .glb of version " + std::to_string(version) + "; version 2 would be right");
  const std::size_t length = WordAt(bytes, 8);
  if (length > bytes.size())
    throw bad("is cut off: " + std::to_string(bytes.size()) + " of " + std::to_string(length) +
              " bytes are there");
  Container container;
  for (std::size_t at = kHeaderSize; at + kChunkHeaderSize <= length;) {
    const std::size_t size = WordAt(bytes, at);
    const std::uint32_t kind = WordAt(bytes, at + 4);
    const bool first = at == kHeaderSize;
    at += kChunkHeaderSize;
    if (size > length - at)
      throw bad("is damaged: a chunk at byte " + std::to_string(at) + " goes beyond the end");
    if (first != (kind == kJsonChunk))
      throw bad("is damaged: its first chunk, and no other, has to be JSON");
    if (first) container.json = bytes.substr(at, size);
    if (kind == kBinChunk && !container.has_binary) {
      container.binary = bytes.substr(at, size);
      container.has_binary = true;
    }
    at += size;
  }
  return container;
}

const nlohmann::json& Member(const nlohmann::json& object, const char* key) {
  static const nlohmann::json kNone;
  if (!object.is_object()) return kNone;
  const auto at = object.find(key);
  return at == object.end() ? kNone : *at;
}

// The first buffer is the container's own unless it names a file.
void CheckBinary(const nlohmann::json& gltf, const Container& container,
                 const std::string& source) {
  const nlohmann::json& buffers = Member(gltf, "buffers");
  if (!buffers.is_array() || buffers.empty() || buffers[0].contains("uri")) return;
  const nlohmann::json& length = Member(buffers[0], "byteLength");
  if (length.is_number_unsigned() && length.get<std::uint64_t>() > container.binary.size())
    throw app::BadInput(source + ": is damaged: its vertices are missing, or a part of them");
}

}  // namespace

nlohmann::json ParseGltf(std::string_view bytes, const std::string& source) {
  const bool binary = bytes.size() >= 4 && WordAt(bytes, 0) == kMagic;
  Container container{bytes, {}, false};
  if (binary) {
    container = OpenContainer(bytes, source);
  } else if (const std::size_t first = bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
             first == std::string_view::npos || bytes[first] != '{') {
    throw app::BadInput(source +
                        ": is no glTF; .glb, .gltf and .vrm are, and Blender makes one of others");
  }
  nlohmann::json gltf;
  try {
    gltf = nlohmann::json::parse(container.json.begin(), container.json.end());
  } catch (const nlohmann::json::parse_error& error) {
    throw app::BadInput(source + ": is damaged: its JSON is wrong at byte " +
                        std::to_string(error.byte));
  } catch (const nlohmann::json::exception&) {
    throw app::BadInput(source + ": is damaged: a number in its JSON is too large");
  }
  const nlohmann::json& version = Member(Member(gltf, "asset"), "version");
  if (!version.is_string() || !version.get_ref<const std::string&>().starts_with("2."))
    throw app::BadInput(source + ": does not say that it is glTF 2 (asset.version)");
  if (binary) CheckBinary(gltf, container, source);
  return gltf;
}

std::string ReadBytes(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw app::BadInput(path + ": is a folder; a .glb, .gltf or .vrm would be right");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw app::BadInput(path + ": " + std::strerror(errno));
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace facewire::tools::rig
