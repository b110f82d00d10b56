#include "app/checked_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/scratch.h"

namespace facewire::app {
namespace {

using testing::HasSubstr;

constexpr FileKind kKind = {"FWTESTED", 3, "sample", "make it again"};

std::vector<std::byte> Bytes(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::string Text(const std::vector<std::byte>& bytes) {
  std::string text;
  for (const std::byte b : bytes) text += static_cast<char>(b);
  return text;
}

TEST(Crc32, MatchesThePublishedCheckValue) {
  EXPECT_EQ(Crc32(Bytes("123456789")), 0xCBF43926U);
  EXPECT_EQ(Crc32({}), 0U);
}

TEST(SealedFile, HasTheLayoutThatFormatsMdSays) {
  const std::string file = Text(Seal(kKind, Bytes("abc")));
  EXPECT_EQ(file.substr(0, 8), "FWTESTED");
  EXPECT_EQ(file.substr(8, 8), std::string("\3\0\0\0\3\0\0\0", 8));
  EXPECT_EQ(file.substr(16, 3), "abc");
  EXPECT_EQ(file.size(), 23U);
}

TEST(SealedFile, GivesItsPayloadBack) {
  const Scratch scratch;
  for (const std::string payload : {"", "x", "hello"}) {
    const auto path = scratch.Write("file", Text(Seal(kKind, Bytes(payload))));
    EXPECT_EQ(Text(ReadSealed(kKind, path)), payload);
  }
}

TEST(SealedFile, EveryTruncationAndEveryFlippedByteIsNoticed) {
  const Scratch scratch;
  const std::string good = Text(Seal(kKind, Bytes("hello")));
  for (std::size_t i = 0; i < good.size(); ++i) {
    const auto cut = scratch.Write("cut", good.substr(0, i));
    EXPECT_THAT(BadInputOf([&] { ReadSealed(kKind, cut); }), HasSubstr("cut: ")) << i;
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x40);
    const auto flipped = scratch.Write("flipped", bad);
    EXPECT_THAT(BadInputOf([&] { ReadSealed(kKind, flipped); }), HasSubstr("flipped: ")) << i;
  }
}

TEST(SealedFile, SaysInOneLineWhatIsWrong) {
  const Scratch scratch;
  const std::string good = Text(Seal(kKind, Bytes("hello")));
  const auto message = [&](const std::string& content) {
    const auto path = scratch.Write("f", content);
    return BadInputOf([&] { ReadSealed(kKind, path); });
  };
  EXPECT_THAT(BadInputOf([&] { ReadSealed(kKind, scratch / "none"); }),
              HasSubstr("none: there is no such sample"));
  EXPECT_THAT(BadInputOf([&] { ReadSealed(kKind, scratch.folder()); }), HasSubstr("not a file"));
  EXPECT_THAT(message("GIF89a and so on and on and on"), HasSubstr("not a facewire sample"));
  EXPECT_THAT(message(""), HasSubstr("not a facewire sample"));
  EXPECT_THAT(message(good.substr(0, 20)), HasSubstr("truncated: 20 of 25 bytes"));
  EXPECT_THAT(message(good + "zz"), HasSubstr("2 bytes too many"));
  std::string damaged = good;
  damaged[18] = '?';
  EXPECT_THAT(message(damaged), HasSubstr("checksum"));
  std::string older = good;
  older[8] = 2;
  EXPECT_THAT(message(older), HasSubstr("of version 2, this program reads version 3"));
}

TEST(WriteFileAtomically, ReplacesTheFileAndLeavesNothingElse) {
  const Scratch scratch;
  const auto path = scratch.Write("file", "old");
  WriteFileAtomically(path, Bytes("new"));
  EXPECT_EQ(Scratch::Read(path), "new");
  EXPECT_EQ(scratch.files(), 1U);
}

TEST(WriteFileAtomically, FailsWithoutATraceWhenTheTargetIsAFolder) {
  const Scratch scratch;
  std::filesystem::create_directories(scratch / "folder" / "sub");
  EXPECT_THROW(WriteFileAtomically(scratch / "folder", Bytes("new")), Failure);
  EXPECT_EQ(scratch.files(), 1U);
  EXPECT_THROW(WriteFileAtomically(scratch / "missing" / "file", Bytes("new")), Failure);
}

TEST(ByteReader, AfterTheEndReadsAreZeroAndNotOk) {
  ByteWriter out;
  out.U8(7);
  out.U16(0x1234);
  out.U32(0x89ABCDEF);
  out.F32(-1.5F);
  out.Text("jaw");
  ByteReader in(out.bytes());
  EXPECT_EQ(in.U8(), 7);
  EXPECT_EQ(in.U16(), 0x1234);
  EXPECT_EQ(in.U32(), 0x89ABCDEFU);
  EXPECT_EQ(in.F32(), -1.5F);
  EXPECT_EQ(in.Text(), "jaw");
  EXPECT_TRUE(in.ok());
  EXPECT_EQ(in.left(), 0U);
  EXPECT_EQ(in.U32(), 0U);
  EXPECT_FALSE(in.ok());
}

}  // namespace
}  // namespace facewire::app
