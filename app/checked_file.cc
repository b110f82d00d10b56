#include "app/checked_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

#include "app/error.h"

namespace facewire::app {
namespace {

constexpr std::size_t kMagicBytes = 8;
constexpr std::size_t kHeaderBytes = kMagicBytes + 8;  // + version + length
constexpr std::size_t kCrcBytes = 4;

[[noreturn]] void Fail(const std::string& path, const char* what) {
  throw Failure(path + ": " + what + ": " + std::strerror(errno));
}

// A file descriptor and the name of a file that goes away unless it is renamed.
class TemporaryFile {
 public:
  TemporaryFile(FileCalls& files, const std::filesystem::path& target)
      : files_(files),
        name_(target.string() + ".XXXXXX"),
        descriptor_(files.OpenTemporary(name_.data())) {
    if (descriptor_ < 0) Fail(target.string(), "cannot create it");
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ >= 0) files_.Close(descriptor_);
    if (!name_.empty()) files_.Unlink(name_.c_str());
  }

  void Write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const ssize_t written = files_.Write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) Fail(name_, "cannot write");
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    // mkostemp makes files that only the owner may read; these files are no secrets.
    if (files_.ChangeMode(descriptor_, S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH) != 0 ||
        files_.Sync(descriptor_) != 0)
      Fail(name_, "cannot write");
  }

  void RenameTo(const std::filesystem::path& target) {
    if (files_.Close(std::exchange(descriptor_, -1)) != 0) Fail(name_, "cannot write");
    if (files_.Rename(name_.c_str(), target.c_str()) != 0)
      Fail(target.string(), "cannot replace it");
    name_.clear();
  }

 private:
  FileCalls& files_;
  std::string name_;
  int descriptor_;
};

// The rename itself is only on the disk when the folder is.
void SyncFolder(FileCalls& files, const std::filesystem::path& folder) {
  const int descriptor = files.Open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC, 0);
  if (descriptor < 0)
    return;  // a folder that may be written but not read: nothing more can be done
  const bool failed = files.Sync(descriptor) != 0 && errno != EINVAL;  // some keep no folders
  const int error = errno;
  files.Close(descriptor);
  errno = error;
  if (failed) Fail(folder.string(), "a loss of power may take back what was written");
}

std::vector<std::byte> ReadWhole(const FileKind& kind, const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status))
    throw BadInput(path.string() + ": there is no such " + std::string(kind.noun));
  if (!std::filesystem::is_regular_file(status))
    throw BadInput(path.string() + ": not a file; expected a " + std::string(kind.noun));
  std::ifstream in(path, std::ios::binary);
  if (!in) throw BadInput(path.string() + ": cannot be opened: " + std::strerror(errno));
  const std::vector<char> text{std::istreambuf_iterator<char>(in), {}};
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

constexpr std::array<std::uint32_t, 256> MakeCrcTable() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    std::uint32_t crc = i;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB88320U : 0U);
    table[i] = crc;
  }
  return table;
}

}  // namespace

void WriteFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes,
                         FileCalls& files) {
  TemporaryFile file(files, path);
  file.Write(bytes);
  file.RenameTo(path);
  SyncFolder(files, path.has_parent_path() ? path.parent_path() : ".");
}

std::uint32_t Crc32(std::span<const std::byte> bytes) {
  static constexpr std::array<std::uint32_t, 256> kTable = MakeCrcTable();
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::byte b : bytes)
    crc = (crc >> 8) ^ kTable[(crc ^ std::to_integer<std::uint32_t>(b)) & 0xFFU];
  return ~crc;
}

std::vector<std::byte> Seal(const FileKind& kind, std::span<const std::byte> payload) {
  ByteWriter header;
  for (const char c : kind.magic) header.U8(static_cast<std::uint8_t>(c));
  header.U32(kind.version);
  header.U32(static_cast<std::uint32_t>(payload.size()));
  std::vector<std::byte> file = header.bytes();
  file.insert(file.end(), payload.begin(), payload.end());
  ByteWriter crc;
  crc.U32(Crc32(file));
  file.insert(file.end(), crc.bytes().begin(), crc.bytes().end());
  return file;
}

std::vector<std::byte> ReadSealed(const FileKind& kind, const std::filesystem::path& path) {
  const std::vector<std::byte> file = ReadWhole(kind, path);
  const std::string noun(kind.noun);
  const auto fail = [&](const std::string& what) {
    throw BadInput(path.string() + ": " + what + "; " + std::string(kind.remedy));
  };
  const std::span<const std::byte> bytes = file;
  const auto magic = std::as_bytes(std::span(kind.magic));
  const std::size_t start = std::min(bytes.size(), magic.size());
  if (bytes.empty() || !std::ranges::equal(bytes.first(start), magic.first(start)))
    fail("this is not a facewire " + noun);
  if (bytes.size() < kHeaderBytes + kCrcBytes) fail("the " + noun + " is truncated");
  ByteReader header(bytes.subspan(kMagicBytes, 8));
  const std::uint32_t version = header.U32();
  const std::uint32_t length = header.U32();
  if (version != kind.version)
    fail("the " + noun + " is of version " + std::to_string(version) +
         ", this program reads version " + std::to_string(kind.version));
  const std::size_t expected = kHeaderBytes + std::size_t{length} + kCrcBytes;
  if (file.size() < expected)
    fail("the " + noun + " is truncated: " + std::to_string(file.size()) + " of " +
         std::to_string(expected) + " bytes");
  if (file.size() > expected)
    fail("the " + noun + " has " + std::to_string(file.size() - expected) +
         " bytes too many at its end");
  ByteReader crc(bytes.last(kCrcBytes));
  if (crc.U32() != Crc32(bytes.first(bytes.size() - kCrcBytes)))
    fail("the " + noun + " is damaged: its checksum is wrong");
  return {file.begin() + kHeaderBytes, file.end() - kCrcBytes};
}

void ByteWriter::U16(std::uint16_t v) {
  for (int shift = 0; shift < 16; shift += 8) U8(static_cast<std::uint8_t>(v >> shift));
}

void ByteWriter::U32(std::uint32_t v) {
  for (int shift = 0; shift < 32; shift += 8) U8(static_cast<std::uint8_t>(v >> shift));
}

void ByteWriter::F32(float v) { U32(std::bit_cast<std::uint32_t>(v)); }

void ByteWriter::Text(std::string_view text) {
  U8(static_cast<std::uint8_t>(text.size()));
  for (const char c : text) U8(static_cast<std::uint8_t>(c));
}

std::uint8_t ByteReader::U8() {
  if (bytes_.empty()) {
    ok_ = false;
    return 0;
  }
  const auto value = std::to_integer<std::uint8_t>(bytes_.front());
  bytes_ = bytes_.subspan(1);
  return value;
}

std::uint16_t ByteReader::U16() {
  const std::uint16_t low = U8();
  return static_cast<std::uint16_t>(low | (U8() << 8));
}

std::uint32_t ByteReader::U32() {
  const std::uint32_t low = U16();
  return low | (std::uint32_t{U16()} << 16);
}

float ByteReader::F32() { return std::bit_cast<float>(U32()); }

std::string ByteReader::Text() {
  std::string text(U8(), '\0');
  for (char& c : text) c = static_cast<char>(U8());
  return text;
}

}  // namespace facewire::app
