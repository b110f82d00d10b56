// What the firmware as it is flashed says of the vectors' streams: its decoder and its line under
// everything else that it does.
#include <gtest/gtest.h>

#include <algorithm>
#include <span>

#include "core/wire/decoder.h"
#include "tests/core/wire/vectors.h"
#include "tests/tools/firmware/simulated_board.h"

namespace facewire::firmware {
namespace {

wire::LinkStats StatsOf(const wire::Bytes& stream) {
  wire::Decoder decoder;
  std::span<const std::byte> rest(stream);
  for (;;) {
    const auto received = decoder.Next(rest);
    if (!received && received.error() == Errc::kNotReady) return decoder.stats();
  }
}

// A frame that does not end is given up after 100 ms, and counted unless its beginning was unseen.
bool IsGivenUp(const wire::Bytes& stream) {
  return !stream.empty() && stream.back() != std::byte{0} &&
         std::find(stream.begin(), stream.end(), std::byte{0}) != stream.end();
}

TEST(Firmware, CountsTheFramesOfEveryVectorAsTheDeviceDoes) {
  for (const wire::Vector& vector : wire::AllVectors()) {
    SimulatedBoard board;
    board.RunFor(40);
    // simavr's line takes eleven bits a byte, and keeps 64 bytes that come too early.
    std::span<const std::byte> rest(vector.stream);
    while (!rest.empty()) {
      const std::size_t size = std::min<std::size_t>(rest.size(), 100);
      board.Send(rest.first(size));
      board.RunFor(12);
      rest = rest.subspan(size);
    }
    board.RunFor(1200);  // longer than from one status to the next
    const auto status = board.TakeStatus();
    ASSERT_FALSE(status.empty()) << vector.name;
    const wire::LinkStats expected = StatsOf(vector.stream);
    EXPECT_EQ(status.back().frames, expected.frames + expected.unknown + expected.malformed)
        << vector.name;
    EXPECT_EQ(status.back().damaged, expected.Damaged() + (IsGivenUp(vector.stream) ? 1U : 0U))
        << vector.name;
    EXPECT_EQ(status.back().lost, expected.lost) << vector.name;
  }
}

}  // namespace
}  // namespace facewire::firmware
