#include "hal/jpeg/jpeg_decoder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "tests/support/allocation_counter.h"
#include "tests/support/jpeg_picture.h"

namespace facewire::hal::jpeg {
namespace {

using facewire::test::DataOffset;
using facewire::test::Jpeg;
using facewire::test::JpegOptions;
using facewire::test::MakeJpeg;
using facewire::test::PixelAt;
using facewire::test::Without;

constexpr std::uint8_t kHuffmanTables = 0xC4;
constexpr std::uint8_t kQuantizationTables = 0xDB;

// The largest difference of a colour to the picture that was compressed.
int LargestError(const ImageView& view, const JpegOptions& options) {
  int largest = 0;
  for (int y = 0; y < view.height_px; ++y) {
    for (int x = 0; x < view.width_px; ++x) {
      const std::uint8_t* pixel = view.planes[0].data + y * view.planes[0].stride_bytes + 3 * x;
      const std::array<int, 3> wanted = PixelAt(options, x, y);
      for (std::size_t c = 0; c < 3; ++c) {
        largest = std::max(largest, std::abs(pixel[c] - wanted[c]));
      }
    }
  }
  return largest;
}

// Decodes to the picture that was compressed.
void ExpectRight(JpegDecoder& decoder, const Jpeg& jpeg, const JpegOptions& options) {
  const Result<ImageView> view = decoder.Decode(jpeg);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->format, PixelFormat::kRgb24);
  EXPECT_EQ(view->width_px, options.width_px);
  EXPECT_EQ(view->height_px, options.height_px);
  EXPECT_EQ(view->planes[0].stride_bytes, 3 * options.width_px);
  EXPECT_LE(LargestError(*view, options), 12);
}
void ExpectRight(const JpegOptions& options) {
  JpegDecoder decoder(options.width_px, options.height_px);
  ExpectRight(decoder, MakeJpeg(options), options);
}

TEST(JpegDecoder, DecodesEveryWayToThinOutColour) {
  for (const int across : {1, 2, 4}) {
    for (const int down : {1, 2, 4}) {
      if (across * down > 8) continue;  // more than 10 blocks together are no baseline JPEG
      SCOPED_TRACE(std::to_string(across) + "x" + std::to_string(down));
      ExpectRight({.across = across, .down = down});
    }
  }
  ExpectRight({.grey = true});
}

TEST(JpegDecoder, DecodesSizesThatAreNoMultipleOfABlock) {
  for (const int down : {1, 2}) {
    ExpectRight({.width_px = 61, .height_px = 43, .down = down});
    ExpectRight({.width_px = 1, .height_px = 1, .down = down});
  }
}

TEST(JpegDecoder, ItsMemoryServesTheWidestPicturesToo) {
  for (const int across : {1, 2}) {
    ExpectRight(
        {.width_px = JpegDecoder::kMaxSidePx, .height_px = 64, .across = across, .down = 4});
  }
  ExpectRight({.width_px = 16, .height_px = JpegDecoder::kMaxSidePx});
}

TEST(JpegDecoder, TakesTheStandardTablesWhereThePictureBringsNone) {
  // Most webcams leave them out, as Motion JPEG allows.
  const JpegOptions options{.shade = 120};
  const Jpeg jpeg = MakeJpeg(options);
  const Jpeg bare = Without(jpeg, kHuffmanTables);
  ASSERT_LT(bare.size(), jpeg.size());
  JpegDecoder decoder(options.width_px, options.height_px);
  ExpectRight(decoder, bare, options);
}

TEST(JpegDecoder, NothingOfOnePictureStaysForTheNext) {
  const JpegOptions options{.shade = 120};
  const Jpeg jpeg = MakeJpeg(options);
  JpegDecoder decoder(options.width_px, options.height_px);
  ExpectRight(decoder, jpeg, options);
  EXPECT_EQ(decoder.Decode(Without(jpeg, kQuantizationTables)).error(), Errc::kCorrupt);

  // Tables of its own that are not the standard ones.
  const Jpeg progressive = MakeJpeg({.progressive = true});
  EXPECT_FALSE(decoder.Decode(progressive));
  ExpectRight(decoder, Without(jpeg, kHuffmanTables), options);
}

TEST(JpegDecoder, RefusesWhatIsNoPictureOfItsSize) {
  const JpegOptions options;
  JpegDecoder decoder(options.width_px, options.height_px);
  const Jpeg jpeg = MakeJpeg(options);
  Jpeg headless(jpeg.begin() + 2, jpeg.end());
  for (const Jpeg& bad :
       {Jpeg{}, Jpeg(100, 0), headless, MakeJpeg({.width_px = 32}), MakeJpeg({.height_px = 32}),
        MakeJpeg({.width_px = 640, .height_px = 480}), MakeJpeg({.progressive = true})}) {
    EXPECT_EQ(decoder.Decode(bad).error(), Errc::kCorrupt);
  }
  ExpectRight(decoder, jpeg, options);
}

TEST(JpegDecoder, RefusesAPictureThatBreaksOffAnywhere) {
  const JpegOptions options{.restart_rows = 1};
  JpegDecoder decoder(options.width_px, options.height_px);
  const Jpeg jpeg = MakeJpeg(options);
  constexpr std::size_t kEndMarker = 2;
  for (std::size_t size = 0; size < jpeg.size() - kEndMarker - 1; ++size) {
    EXPECT_FALSE(decoder.Decode({jpeg.data(), size})) << size << " of " << jpeg.size();
  }
  ExpectRight(decoder, jpeg, options);
}

TEST(JpegDecoder, TakesAPictureThatLacksOnlyItsEndMarkerOrHasMoreAfterIt) {
  const JpegOptions options;
  JpegDecoder decoder(options.width_px, options.height_px);
  Jpeg jpeg = MakeJpeg(options);
  ExpectRight(decoder, Jpeg(jpeg.begin(), jpeg.end() - 2), options);
  jpeg.resize(jpeg.size() + 5000);
  ExpectRight(decoder, jpeg, options);
}

TEST(JpegDecoder, ToleratesAFewBytesTooManyBeforeAMarker) {
  const JpegOptions options;
  JpegDecoder decoder(options.width_px, options.height_px);
  Jpeg jpeg = MakeJpeg(options);
  jpeg.insert(jpeg.end() - 2, 10, 0x55);
  ExpectRight(decoder, jpeg, options);
  jpeg.insert(jpeg.end() - 2, 30, 0x55);
  EXPECT_EQ(decoder.Decode(jpeg).error(), Errc::kCorrupt);
}

TEST(JpegDecoder, RefusesAStretchThatIsMissing) {
  const JpegOptions options{.restart_rows = 1};
  JpegDecoder decoder(options.width_px, options.height_px);
  Jpeg jpeg = MakeJpeg(options);
  const auto data = jpeg.begin() + static_cast<std::ptrdiff_t>(DataOffset(jpeg));
  jpeg.erase(data + (jpeg.end() - data) / 3, data + 2 * (jpeg.end() - data) / 3);
  EXPECT_EQ(decoder.Decode(jpeg).error(), Errc::kCorrupt);
}

TEST(JpegDecoder, DecodingAllocatesNothing) {
  using facewire::test::AllocationCounter;
  if (!AllocationCounter::kAvailable) GTEST_SKIP() << AllocationCounter::kWhyNot;
  const JpegOptions options{.width_px = 640, .height_px = 480, .restart_rows = 1};
  const Jpeg jpeg = MakeJpeg(options);
  const Jpeg bare = Without(jpeg, kHuffmanTables);
  const Jpeg progressive = MakeJpeg({.width_px = 640, .height_px = 480, .progressive = true});
  JpegDecoder decoder(options.width_px, options.height_px);
  AllocationCounter counter;
  counter.Arm();
  const bool first = decoder.Decode(jpeg).has_value();
  const bool cut = decoder.Decode({jpeg.data(), jpeg.size() / 2}).has_value();
  const bool several = decoder.Decode(progressive).has_value();
  const bool none = decoder.Decode({}).has_value();
  const bool last = decoder.Decode(bare).has_value();
  counter.Disarm();
  counter.PrintFirst();
  EXPECT_TRUE(first);
  EXPECT_FALSE(cut);
  EXPECT_FALSE(several);
  EXPECT_FALSE(none);
  EXPECT_TRUE(last);
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_EQ(counter.frees(), 0U);
}

// Whatever the bytes are: an answer, and the next good picture comes out right.
TEST(JpegDecoder, SurvivesAnyDamage) {
  const JpegOptions options{.shade = 60, .restart_rows = 1};
  const Jpeg good = MakeJpeg(options);
  JpegDecoder decoder(options.width_px, options.height_px);
  std::mt19937 random(7);
  int refused = 0;
  constexpr int kRounds = 4000;
  for (int round = 0; round < kRounds; ++round) {
    Jpeg bad = good;
    const int hits = 1 + static_cast<int>(random() % 8);
    // Every other round spares no part of the header.
    const std::size_t area = round % 2 == 0 ? DataOffset(good) : good.size();
    for (int hit = 0; hit < hits; ++hit) bad[random() % area] = static_cast<std::uint8_t>(random());
    if (!decoder.Decode(bad)) ++refused;
    if (round % 100 == 0) ExpectRight(decoder, good, options);
  }
  EXPECT_GT(refused, kRounds / 4);
}

}  // namespace
}  // namespace facewire::hal::jpeg
