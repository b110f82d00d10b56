#ifndef FACEWIRE_APP_CHECKED_FILE_H_
#define FACEWIRE_APP_CHECKED_FILE_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/file_calls.h"

namespace facewire::app {

// Writes the whole file or nothing: to a temporary file in the same folder, flushed to the disk,
// then renamed over `path`. A reader, or a board that loses power, sees the old file or the new
// one. Failure: says which step failed and why; the old file is still there, unless it was the last
// step, which makes the new one outlast a loss of power.
void WriteFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes,
                         FileCalls& files = LinuxFiles());

// What distinguishes one kind of facewire's binary files from another.
struct FileKind {
  std::string_view magic;  // 8 characters
  std::uint32_t version;
  std::string_view noun;    // "profile", for messages
  std::string_view remedy;  // what makes a good one: "make it again with facewire train"
};

// The frame that facewire's own binary files share (byte by byte in app/formats.md): magic,
// version, length, payload, CRC-32. All numbers are little-endian.
std::vector<std::byte> Seal(const FileKind& kind, std::span<const std::byte> payload);

// The payload of `path`. BadInput, one line: missing or unreadable, not this kind of file, another
// version (both named), truncated, trailing bytes, wrong checksum.
std::vector<std::byte> ReadSealed(const FileKind& kind, const std::filesystem::path& path);

// CRC-32 as in zip and Ethernet (polynomial 0x04C11DB7 reflected, all ones in and out).
std::uint32_t Crc32(std::span<const std::byte> bytes);

// Appends little-endian values.
class ByteWriter {
 public:
  void U8(std::uint8_t v) { bytes_.push_back(std::byte{v}); }
  void U16(std::uint16_t v);
  void U32(std::uint32_t v);
  void F32(float v);
  void Text(std::string_view text);  // one byte of length, then the characters
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

// Reads them back. After the end, reads give zeros and ok() is false.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::uint8_t U8();
  std::uint16_t U16();
  std::uint32_t U32();
  float F32();
  std::string Text();
  std::size_t left() const { return bytes_.size(); }
  bool ok() const { return ok_; }

 private:
  std::span<const std::byte> bytes_;
  bool ok_ = true;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_CHECKED_FILE_H_
