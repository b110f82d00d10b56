#include "app/landmark_feed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "app/host_line.h"
#include "core/wire/pose.h"
#include "core/wire/rig_description.h"
#include "hal/fake/fake_clock.h"
#include "tests/app/service_context.h"
#include "tests/app/slow_port.h"

namespace facewire::app {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::size_t kParts = 15;  // of a whole face

Landmarks Face(std::uint64_t seq, Time captured, std::size_t count = kMaxLandmarks) {
  Landmarks face{
      .seq = seq, .captured = captured, .width_px = 640, .height_px = 480, .count = count};
  for (std::size_t i = 0; i < count; ++i) face.points_px[i].x = static_cast<float>(i);
  return face;
}

// How many pictures of a camera's `fps` a feed takes in ten seconds that sends each at once.
int TakenOf(double fps, float wanted, Duration jitter = {}) {
  LandmarkFeed feed;
  EXPECT_TRUE(feed.Ask(wanted, Time{}));
  int taken = 0;
  for (int i = 0; i < static_cast<int>(10 * fps); ++i) {
    const auto even = Duration(static_cast<Duration::rep>(1e6 * i / fps));
    feed.Offer(Face(1, Time{even + (i % 2 == 0 ? jitter : -jitter)}, 0));
    taken += feed.part() ? 1 : 0;
    feed.Next();
  }
  return taken;
}

TEST(LandmarkFeed, GivesAsManyPicturesAsAskedForOrAsThereAre) {
  EXPECT_NEAR(TakenOf(24, 30), 240, 1);
  EXPECT_NEAR(TakenOf(30, 30), 300, 1);
  EXPECT_NEAR(TakenOf(30, 30, milliseconds(3)), 300, 1) << "a camera's pictures come unevenly";
  EXPECT_NEAR(TakenOf(24, 10), 100, 1);
  EXPECT_NEAR(TakenOf(60, 30), 300, 1);
  EXPECT_NEAR(TakenOf(30, 0.01F), 2, 1) << "a host that asks gets some";
}

TEST(LandmarkFeed, FinishesAPictureAndThenTakesTheNewest) {
  LandmarkFeed feed;
  ASSERT_TRUE(feed.Ask(60, Time{}));
  std::vector<std::uint32_t> seqs;
  for (std::uint64_t seq = 1; seq <= 40; ++seq) {
    feed.Offer(Face(seq, Time{milliseconds(33 * seq)}));
    const auto part = feed.part();
    ASSERT_TRUE(part);
    seqs.push_back(part->frame_seq);
    feed.Next();
  }
  EXPECT_EQ(std::ranges::count(seqs, 1U), kParts);
  EXPECT_EQ(std::ranges::count(seqs, 16U), kParts);
  EXPECT_EQ(std::ranges::count(seqs, 31U), 10);
}

TEST(LandmarkFeed, GoesOnAfterAClockThatBeganAnew) {
  LandmarkFeed feed;
  ASSERT_TRUE(feed.Ask(10, Time{}));
  feed.Offer(Face(1, Time{seconds(100)}, 0));
  feed.Next();
  feed.Offer(Face(2, Time{seconds(1)}, 0));
  EXPECT_TRUE(feed.part());
}

TEST(LandmarkFeed, EndsWhenTheHostStopsAsking) {
  LandmarkFeed feed;
  EXPECT_FALSE(feed.asked(Time{seconds(1)}));
  ASSERT_TRUE(feed.Ask(30, Time{seconds(1)}));
  EXPECT_TRUE(feed.asked(Time{seconds(1)}));
  EXPECT_TRUE(feed.asked(Time{seconds(6)} - microseconds(1)));
  EXPECT_FALSE(feed.asked(Time{seconds(6)}));
  ASSERT_TRUE(feed.Ask(30, Time{seconds(7)}));
  ASSERT_TRUE(feed.Ask(0, Time{seconds(8)}));
  EXPECT_FALSE(feed.asked(Time{seconds(8)}));
}

TEST(LandmarkFeed, WhoAsksAnewGetsNoOldPicture) {
  LandmarkFeed feed;
  ASSERT_TRUE(feed.Ask(30, Time{seconds(1)}));
  feed.Offer(Face(1, Time{seconds(1)}));
  ASSERT_TRUE(feed.Ask(30, Time{seconds(60)}));
  EXPECT_FALSE(feed.part());
}

TEST(LandmarkFeed, RefusesARateThatIsNone) {
  LandmarkFeed feed;
  for (const float bad : {-1.0F, 60.1F, std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity()}) {
    EXPECT_FALSE(feed.Ask(bad, Time{})) << bad;
    EXPECT_FALSE(feed.asked(Time{})) << bad;
  }
}

// A minute of 30 poses of 64 channels a second on a UART.
struct Minute {
  explicit Minute(int baud, float wanted) : port(clock, baud) {
    for (int i = 0; i < 64; ++i) {
      Channel channel;
      channel.name = *ShortName::From("channel" + std::to_string(i));
      EXPECT_TRUE(rig.channels.try_push(channel));
    }
    line.SetRig(rig, wire::RigId(rig));
    EXPECT_TRUE(line.Open());
    for (std::uint64_t seq = 0; seq < 1800; ++seq) Tick(seq, wanted);
    Read();
  }
  void Tick(std::uint64_t seq, float wanted) {
    const Time now = clock.Now();
    EXPECT_TRUE(wanted == 0 || seq % 60 != 0 || line.AskLandmarks(wanted));
    if (line.landmarks_asked()) line.OfferLandmarks(Face(seq, now));
    RigPose values = rig.NeutralPose();
    values.seq = seq;
    values.captured = now;
    const wire::Status status;
    const auto pose = wire::MakePose(rig, 1, values, ServiceState::kTracking, now);
    EXPECT_TRUE(line.Send(pose, seq % 30 == 0 ? &status : nullptr));
    clock.Advance(microseconds(33'333));
  }
  void Read() {
    wire::Decoder decoder;
    std::vector<bool> have;
    for (const SlowPort::Arrival& a : port.arrivals) {
      std::span<const std::byte> rest(&a.byte, 1);
      const auto got = decoder.Next(rest);
      if (!got) continue;
      if (const auto* pose = std::get_if<wire::Pose>(&got->message)) {
        delays.push_back(a.at - pose->captured);
      } else if (const auto* part = std::get_if<wire::LandmarkPart>(&got->message)) {
        if (part->first == 0) have.assign(part->total, false);
        for (std::size_t i = 0; i < part->points.size(); ++i) have.at(part->first + i) = true;
        if (part->first + part->points.size() < part->total) continue;
        EXPECT_EQ(std::ranges::count(have, false), 0) << part->frame_seq;
        ++pictures;
      }
    }
    EXPECT_EQ(decoder.stats().Damaged() + decoder.stats().lost, 0U);
    std::ranges::sort(delays);
  }
  double Ms(double part) const {
    return Seconds(
               delays[static_cast<std::size_t>(part * static_cast<double>(delays.size() - 1))]) *
           1e3;
  }

  hal::fake::FakeClock clock{Time{seconds(1000)}};
  Rig rig;
  SlowPort port;
  HostLine line{&port, clock, milliseconds(5)};
  std::vector<Duration> delays;  // of the poses, from Send to their last bit
  int pictures = 0;
};

TEST(Landmarks, NeverDisturbThePosesOfASlowLineAndComeWhole) {
  const Minute without(115200, 0);
  const Minute with(115200, 30);
  std::printf(
      "pose to its last bit at 115200 baud, ms: median %.1f, 99%% %.1f, worst %.1f; with "
      "%.1f pictures of landmarks a second %.1f, %.1f, %.1f\n",
      without.Ms(0.5), without.Ms(0.99), without.Ms(1), with.pictures / 60.0, with.Ms(0.5),
      with.Ms(0.99), with.Ms(1));
  EXPECT_EQ(without.pictures, 0) << "nobody asked";
  ASSERT_EQ(with.delays.size(), without.delays.size());
  EXPECT_DOUBLE_EQ(with.Ms(0.5), without.Ms(0.5));
  EXPECT_DOUBLE_EQ(with.Ms(0.99), without.Ms(0.99));
  EXPECT_LE(with.Ms(1), without.Ms(0.99) + 14) << "one part";
  EXPECT_GE(with.pictures, 100);
}

TEST(Landmarks, WaitForNothingOnAFastLine) {
  const Minute fast(1'000'000, 30);
  EXPECT_GE(fast.pictures, 1700);
  const Minute fewer(1'000'000, 10);
  EXPECT_NEAR(fewer.pictures, 600, 10);
}

// 9600 baud carry six such poses a second: there is no room.
TEST(Landmarks, StayAwayFromALineThatCannotEvenCarryThePoses) {
  hal::fake::FakeClock clock{Time{seconds(1000)}};
  SlowPort port(clock, 9600);
  HostLine line(&port, clock, milliseconds(5));
  const Rig rig = SmallRig();
  line.SetRig(rig, wire::RigId(rig));
  ASSERT_TRUE(line.Open());
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(line.AskLandmarks(30));
    line.OfferLandmarks(Face(1, clock.Now()));
    (void)line.Send(wire::MakePose(rig, 1, rig.NeutralPose(), ServiceState::kTracking, clock.Now()),
                    nullptr);
    clock.Advance(milliseconds(10));
  }
  wire::Decoder decoder;
  for (const SlowPort::Arrival& a : port.arrivals) {
    std::span<const std::byte> rest(&a.byte, 1);
    const auto got = decoder.Next(rest);
    EXPECT_FALSE(got && std::holds_alternative<wire::LandmarkPart>(got->message));
  }
}

}  // namespace
}  // namespace facewire::app
