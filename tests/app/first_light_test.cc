// The whole path over the whole clip: real footage through the service, real bytes over a
// pseudo-terminal, and what a host makes of them compared with what the landmarks show.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/application.h"
#include "core/wire/decoder.h"
#include "core/wire/pose.h"
#include "core/wire/rig_description.h"
#include "hal/pty/pty_port.h"
#include "hal/replay/replay_camera.h"
#include "hal/system_clock.h"
#include "tests/app/process.h"
#include "tests/app/scratch.h"
#include "tests/support/footage.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;

const char* const kClip = FACEWIRE_ASSETS "/footage/franck.mp4";

// A host: decodes whatever comes.
struct Host {
  void Take(std::span<const std::byte> bytes) {
    heard.insert(heard.end(), bytes.begin(), bytes.end());
    for (;;) {
      const auto got = decoder.Next(bytes);
      if (got) {
        rig.Add(got->message);
        if (const auto* pose = std::get_if<wire::Pose>(&got->message)) poses.push_back(*pose);
        sequences.push_back(got->sequence);
      } else if (got.error() == Errc::kNotReady) {
        return;
      }
    }
  }

  std::vector<std::byte> heard;
  wire::Decoder decoder;
  wire::RigCollector rig;
  std::vector<wire::Pose> poses;
  std::vector<std::uint16_t> sequences;
};

// What the landmarks of one frame show, in parts of the face itself.
struct Shown {
  float eyes_open = 0;  // distance of the lids over the width of the eye, mean of both
  float lips_open = 0;  // distance of the inner lips in px
};

float Distance(const Landmarks& face, std::size_t a, std::size_t b) {
  return std::hypot(face.points_px[a].x - face.points_px[b].x,
                    face.points_px[a].y - face.points_px[b].y);
}
float Height(const Landmarks& face, std::size_t a, std::size_t b) {
  return std::abs(face.points_px[a].y - face.points_px[b].y);
}

// By the frame's number; frames without a face are missing.
std::map<std::uint64_t, Shown> ReadClip() {
  const test::NetworkBytes networks(track::Model::kAttention);
  std::vector<std::byte> block(track::Tracker::RequiredBytes(track::Model::kAttention));
  Arena arena(block);
  const auto tracker = std::make_unique<track::Tracker>();
  std::map<std::uint64_t, Shown> shown;
  if (!tracker->Load({}, networks.files(), arena)) return shown;
  hal::SystemClock clock;
  hal::replay::ReplayCamera camera({.path = kClip, .pace = hal::Pace::kFast}, clock);
  if (!camera.Start()) return shown;
  while (const auto frame = camera.Acquire(milliseconds(0))) {
    const auto face = tracker->Update(*frame);
    if (!face) continue;
    const float right = Height(*face, 159, 145) / Distance(*face, 33, 133);
    const float left = Height(*face, 386, 374) / Distance(*face, 362, 263);
    shown[frame->seq] = {.eyes_open = (right + left) / 2, .lips_open = Distance(*face, 13, 14)};
  }
  return shown;
}

// The service over the whole clip, once for all tests: it takes a while.
class FirstLight : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    run_ = std::make_unique<Run>();
    Run& run = *run_;
    const Scratch scratch;
    scratch.Write("facewire.toml", std::string("[camera.replay]\nfile = \"") + kClip +
                                       "\"\npace = \"fast\"\n[tracker]\nnetworks = \"" +
                                       FACEWIRE_ASSETS "/networks\"\n[character]\nrig = \"" +
                                       FACEWIRE_SOURCE_DIR "/app/share/otto.toml\"\nprofile = \"" +
                                       FACEWIRE_SOURCE_DIR
                                       "/app/share/average.profile\"\n[neutral]\nfolder = \"state\""
                                       // Nothing may be lost, so wait for the host if need be.
                                       "\n[host]\nline = \"pty:line\"\nwrite_budget_ms = 20\n");
    hal::SystemClock clock;
    Journal journal;
    Application application({.config = scratch / "facewire.toml", .fake = true}, clock, journal);
    application.Open();
    hal::pty::PtyPort line((scratch / "line").string());
    ASSERT_TRUE(line.Open());
    std::atomic<bool> finished = false;
    std::jthread host([&] {
      std::array<std::byte, 8192> buffer;
      for (;;) {
        const bool last = finished;
        const auto read = line.Read(buffer, milliseconds(20));
        if (read) {
          run.host.Take(std::span(buffer).first(*read));
        } else if (last) {
          return;
        }
      }
    });
    std::jthread reference([&] { run.shown = ReadClip(); });
    Requests requests;
    application.Run(requests, Duration::zero());
    finished = true;
    host.join();
    run.report = application.Report();
  }
  static void TearDownTestSuite() { run_.reset(); }

  struct Run {
    Host host;
    std::map<std::uint64_t, Shown> shown;
    RunReport report;
  };
  static const Host& host() { return run_->host; }
  static const RunReport& report() { return run_->report; }

  // A channel beside the landmarks, frame by frame, from the first pose that follows the face on.
  struct Pair {
    Shown shown;
    float value = 0;
  };
  static std::vector<Pair> Pairs(const std::vector<const char*>& channels) {
    const Rig& rig = host().rig.rig();
    std::vector<Pair> pairs;
    std::optional<std::uint32_t> last;
    for (const wire::Pose& pose : host().poses) {
      // Only after the last frame are there several poses of one: easing to neutral.
      if (pose.state != ServiceState::kTracking && !last) continue;
      if (last && pose.frame_seq == *last) continue;
      last = pose.frame_seq;
      const auto shown = run_->shown.find(pose.frame_seq);
      if (shown == run_->shown.end()) continue;
      const RigPose values = wire::ValuesOf(pose, rig);
      float sum = 0;
      for (const char* name : channels) {
        const auto channel = rig.FindChannel(name);
        if (!channel) return {};
        sum += values.values[*channel];
      }
      pairs.push_back({shown->second, sum / static_cast<float>(channels.size())});
    }
    return pairs;
  }

 private:
  inline static std::unique_ptr<Run> run_;
};

// Stretches [begin, end) in which `is` holds.
template <class Is>
std::vector<std::pair<std::size_t, std::size_t>> Stretches(std::size_t count, Is is) {
  std::vector<std::pair<std::size_t, std::size_t>> stretches;
  for (std::size_t i = 0; i < count; ++i) {
    if (!is(i)) continue;
    if (stretches.empty() || stretches.back().second != i) stretches.emplace_back(i, i);
    stretches.back().second = i + 1;
  }
  return stretches;
}

TEST_F(FirstLight, NothingIsDamagedOrLostOnTheLine) {
  const wire::LinkStats& line = host().decoder.stats();
  EXPECT_EQ(line.Damaged(), 0U);
  EXPECT_EQ(line.crc_errors, 0U);
  EXPECT_EQ(line.cobs_errors, 0U);
  EXPECT_EQ(line.lost, 0U);
  EXPECT_EQ(line.malformed + line.unknown + line.versions, 0U);
  EXPECT_EQ(report().poses_dropped, 0U);
  EXPECT_EQ(report().line_errors, 0U);
  EXPECT_EQ(host().poses.size(), report().poses_sent);
  EXPECT_GE(report().frames, 4000U) << "the whole clip";
  EXPECT_EQ(report().frames_dropped, 0U);
}

TEST_F(FirstLight, EveryChannelStaysWithinItsLimits) {
  ASSERT_TRUE(host().rig.Complete());
  const Rig& rig = host().rig.rig();
  ASSERT_FALSE(host().poses.empty());
  for (const wire::Pose& pose : host().poses) {
    ASSERT_EQ(pose.rig_id, host().rig.rig_id());
    const RigPose values = wire::ValuesOf(pose, rig);
    ASSERT_EQ(values.count, rig.channels.size());
    for (std::size_t i = 0; i < values.count; ++i) {
      ASSERT_GE(values.values[i], rig.channels[i].min) << rig.channels[i].name.view();
      ASSERT_LE(values.values[i], rig.channels[i].max) << rig.channels[i].name.view();
    }
  }
}

TEST_F(FirstLight, BlinksWhenThePerformerBlinksAndOnlyThen) {
  const std::vector<Pair> pairs = Pairs({"eyeBlinkLeft", "eyeBlinkRight"});
  ASSERT_GT(pairs.size(), 4000U);
  std::vector<float> openings;
  openings.reserve(pairs.size());
  for (const Pair& pair : pairs) openings.push_back(pair.shown.eyes_open);
  const auto middle = openings.begin() + static_cast<std::ptrdiff_t>(openings.size() / 2);
  std::ranges::nth_element(openings, middle);
  const float closed = 0.6F * *middle;
  const auto blinks =
      Stretches(pairs.size(), [&](std::size_t i) { return pairs[i].shown.eyes_open < closed; });
  const auto answers =
      Stretches(pairs.size(), [&](std::size_t i) { return pairs[i].value > 0.5F; });
  const auto touch = [](const auto& a, const auto& b) {
    return a.first < b.second && b.first < a.second;
  };
  const auto answered = std::ranges::count_if(blinks, [&](const auto& blink) {
    return std::ranges::any_of(answers, [&](const auto& a) { return touch(a, blink); });
  });
  const auto extra = std::ranges::count_if(answers, [&](const auto& answer) {
    return std::ranges::none_of(blinks, [&](const auto& b) { return touch(b, answer); });
  });
  std::printf("blinks: %zu shown, %td answered, %td extra\n", blinks.size(), answered, extra);
  const auto shown = static_cast<double>(blinks.size());
  EXPECT_GE(blinks.size(), 20U);
  EXPECT_GE(static_cast<double>(answered), 0.9 * shown);
  EXPECT_LE(static_cast<double>(extra), 0.1 * shown);
}

TEST_F(FirstLight, OpensTheJawAsThePerformerOpensTheLips) {
  const std::vector<Pair> pairs = Pairs({"jawOpen"});
  ASSERT_GT(pairs.size(), 4000U);
  const auto n = static_cast<double>(pairs.size());
  double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  for (const Pair& pair : pairs) {
    const double lips = pair.shown.lips_open;
    const double jaw = pair.value;
    x += lips;
    y += jaw;
    xx += lips * lips;
    yy += jaw * jaw;
    xy += lips * jaw;
  }
  const double correlation = (xy - x * y / n) / std::sqrt((xx - x * x / n) * (yy - y * y / n));
  std::printf("jawOpen and the lips: correlation %.3f over %zu frames\n", correlation,
              pairs.size());
  EXPECT_GE(correlation, 0.9);
}

// Where the frames of the stream begin and end, both delimiters included. An inner byte is never 0.
std::vector<std::pair<std::size_t, std::size_t>> FramesOf(std::span<const std::byte> bytes) {
  const auto inner =
      Stretches(bytes.size(), [&](std::size_t i) { return bytes[i] != std::byte{0}; });
  std::vector<std::pair<std::size_t, std::size_t>> frames;
  frames.reserve(inner.size());
  for (const auto& [begin, end] : inner) frames.emplace_back(begin - 1, end + 1);
  return frames;
}

TEST_F(FirstLight, ADamagedByteCostsItsOwnFrameAndNoOther) {
  const std::span<const std::byte> all = host().heard;
  const auto frames = FramesOf(all);
  ASSERT_EQ(frames.size(), host().sequences.size());
  constexpr std::size_t kFirst = 200;
  constexpr std::size_t kHit = 203;
  constexpr std::size_t kEnd = 206;
  const auto piece = all.subspan(frames[kFirst].first, frames[kEnd].first - frames[kFirst].first);
  std::vector<std::uint16_t> rest(host().sequences.begin() + kFirst,
                                  host().sequences.begin() + kEnd);
  rest.erase(rest.begin() + (kHit - kFirst));
  const std::size_t begin = frames[kHit].first - frames[kFirst].first;
  const std::size_t end = frames[kHit].second - frames[kFirst].first;
  // Inside: the delimiters are doubled between frames, so that one may be damaged.
  for (std::size_t at = begin + 1; at + 1 < end; ++at) {
    for (const auto damage : {piece[at] ^ std::byte{0x10}, std::byte{0}}) {
      std::vector<std::byte> bytes(piece.begin(), piece.end());
      if (bytes[at] == damage) continue;
      bytes[at] = damage;
      Host other;
      other.Take(bytes);
      ASSERT_EQ(other.sequences, rest) << "byte " << at - begin;
      ASSERT_GE(other.decoder.stats().Damaged(), 1U);
      ASSERT_EQ(other.decoder.stats().lost, 1U);
    }
  }
}

TEST_F(FirstLight, AfterACutTheNextFrameIsRead) {
  const std::span<const std::byte> all = host().heard;
  const auto frames = FramesOf(all);
  ASSERT_EQ(frames.size(), host().sequences.size());
  // From the middle of one frame to the middle of a later one.
  const std::size_t from = (frames[100].first + frames[100].second) / 2;
  const std::size_t to = (frames[110].first + frames[110].second) / 2;
  std::vector<std::byte> bytes(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(from));
  bytes.insert(bytes.end(), all.begin() + static_cast<std::ptrdiff_t>(to), all.end());
  Host other;
  other.Take(bytes);
  std::vector<std::uint16_t> rest = host().sequences;
  rest.erase(rest.begin() + 100, rest.begin() + 111);
  EXPECT_EQ(other.sequences, rest);
  EXPECT_EQ(other.decoder.stats().Damaged(), 1U);
  EXPECT_EQ(other.decoder.stats().lost, 11U);
  EXPECT_EQ(other.decoder.stats().resyncs, 1U);
}

TEST_F(FirstLight, TheMonitorReadsTheStreamWithoutAnError) {
  const Scratch scratch;
  const auto& heard = host().heard;
  scratch.Write("stream", {reinterpret_cast<const char*>(heard.data()), heard.size()});
  Process monitor({FACEWIRE_TOOL, "monitor", (scratch / "stream").string(), "--summary"},
                  scratch / "out", scratch / "err");
  EXPECT_EQ(monitor.Wait(), 0) << monitor.err();
  std::printf("%s", monitor.out().c_str());
  EXPECT_NE(monitor.out().find(std::to_string(host().poses.size()) + " poses"), std::string::npos);
}

}  // namespace
}  // namespace facewire::app
