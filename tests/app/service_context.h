#ifndef FACEWIRE_TESTS_APP_SERVICE_CONTEXT_H_
#define FACEWIRE_TESTS_APP_SERVICE_CONTEXT_H_

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/service.h"
#include "core/wire/decoder.h"
#include "core/wire/encoder.h"
#include "core/wire/pose.h"
#include "core/wire/rig_description.h"
#include "hal/fake/fake_camera.h"
#include "hal/fake/fake_clock.h"
#include "hal/fake/fake_gpio.h"
#include "hal/fake/fake_serial_port.h"
#include "tests/core/retarget/training_example.h"

namespace facewire::app {

// Sees in every picture what the test says.
class ScriptedFollower final : public Follower {
 public:
  Result<Followed> Follow(const Frame& frame) noexcept override {
    if (failure) return *failure;
    Followed followed;
    followed.face = face;
    followed.face.seq = frame.seq;
    followed.face.captured = frame.captured;
    if (act) act(followed.face);
    followed.landmarks = landmarks;
    followed.rig.count = 3;
    followed.rig.values[0] = jaw;
    followed.rig.values[1] = followed.rig.values[2] = blink;
    return followed;
  }
  void Forget() noexcept override { ++forgotten; }
  void Use(Character& /*character*/, const filter::FilterConfig& /*filter*/) noexcept override {
    ++uses;
  }

  std::optional<Errc> failure = Errc::kNoFace;
  float jaw = 10;
  float blink = 0;
  FacePose face;
  Landmarks landmarks;
  std::function<void(FacePose&)> act;  // what the face does at its time
  int forgotten = 0;
  int uses = 0;
};

inline Rig SmallRig() {
  Rig rig;
  rig.name = *ShortName::From("small");
  EXPECT_TRUE(rig.bones.try_push({.name = *ShortName::From("jaw"), .landmark = 152}));
  Channel jaw;
  jaw.name = *ShortName::From("jaw.pitch");
  jaw.kind = ChannelKind::kPitch;
  jaw.bone = 0;
  jaw.neutral = 1;
  jaw.min = -5;
  jaw.max = 20;
  EXPECT_TRUE(rig.channels.try_push(jaw));
  for (const char* name : {"eyeBlinkLeft", "eyeBlinkRight"}) {
    Channel blink;
    blink.name = *ShortName::From(name);
    EXPECT_TRUE(rig.channels.try_push(blink));
  }
  return rig;
}

// A service on fakes: 30 pictures a second, no time passes but by the service's own waiting.
class ServiceContext {
 public:
  ServiceContext() : capture_memory(retarget::NeutralCapture::RequiredBytes()) {
    picture.width_px = picture.height_px = 2;
    picture.planes[0] = {pixels.data(), 2};
    Configure(character, SmallRig());
    retarget::NeutralCaptureConfig capture_config;
    capture_config.duration = std::chrono::seconds(1);
    Arena arena(capture_memory);
    EXPECT_TRUE(capture.Configure(capture_config, arena));
    config.states.start_ramp = std::chrono::milliseconds(200);
    config.states.acquire = std::chrono::milliseconds(100);
    config.states.hold = std::chrono::milliseconds(300);
    config.states.ease = std::chrono::milliseconds(400);
    config.states.rest_after = std::chrono::seconds(5);
    config.states.camera_timeout = std::chrono::seconds(1);
    config.states.neutral_frames = 5;
    EXPECT_TRUE(camera.Start());
    EXPECT_TRUE(line.Open());
  }
  void Begin() {
    service.emplace(
        config,
        ServiceParts{
            .camera = camera,
            .line = line,
            .clock = clock,
            .follower = follower,
            .capture = capture,
            .control = &control,
            .stop = &stop,
            .calibrate = &button,
            .status_led = &led,
            .servo_power = &power,
            .keep_neutral =
                [this](const retarget::Neutral&) {
                  ++kept;
                  return why_not_kept;
                },
            .latch = &*latch,
            .log_answer = [this](const wire::Acknowledgement& answer) { logged.push_back(answer); },
            .log_panel = [this](const char* text) { said.emplace_back(text); }},
        character);
  }
  void Configure(Character& which, const Rig& rig) {
    which.rig = rig;
    which.rig_id = wire::RigId(rig);
    memories.emplace_back(retarget::Retargeter::RequiredBytes());
    Arena arena(memories.back());
    EXPECT_TRUE(which.retargeter.Configure(which.rig, nullptr, arena));
  }

  // The character has two profiles, and the second one is the performer's own; before Begin.
  void GivePersonalProfile() {
    ASSERT_TRUE(profile.Configure({}));
    Arena arena(memories.front());
    ASSERT_TRUE(
        character.retargeter.Configure(character.rig, &profile.mapping, arena, &profile.mapping));
  }

  // Ticks for so long by the clock; stops when the service has finished.
  void For(Duration time) {
    for (const Time end = clock.Now() + time; clock.Now() < end && alive;) Tick();
  }
  bool Tick() {
    if (!service) Begin();
    alive = service->Tick();
    Receive();
    return alive;
  }
  void BringToTracking() {
    For(std::chrono::milliseconds(500));
    follower.failure.reset();
    For(std::chrono::milliseconds(500));
    ASSERT_EQ(service->state(), ServiceState::kTracking);
  }
  void SendCommand(wire::CommandCode code, std::uint16_t id = 7, float value = 0,
                   std::uint8_t item = 0) {
    std::array<std::byte, wire::kCommandFrameBytes> frame;
    const auto bytes = host_encoder.Encode(
        wire::Command{.id = id, .code = code, .value = value, .item = item}, frame);
    ASSERT_TRUE(bytes);
    ASSERT_TRUE(port.Feed(*bytes));
  }
  float Jaw() const { return wire::ValuesOf(last_pose, host_rig.rig()).values[0]; }

  hal::fake::FakeClock clock{Time{std::chrono::seconds(1000)}};
  std::array<std::uint8_t, 4> pixels{};
  ImageView picture;
  hal::fake::FakeCamera camera{{.pictures = std::span(&picture, 1)}, clock};
  hal::fake::FakeSerialPort port{clock};
  hal::fake::FakeGpioInput stop;
  hal::fake::FakeGpioInput button;
  hal::fake::FakeGpioOutput led{clock};
  hal::fake::FakeGpioOutput power{clock};
  ScriptedFollower follower;
  Character character;
  std::vector<std::vector<std::byte>> memories;
  std::vector<std::byte> capture_memory;
  retarget::NeutralCapture capture;
  ServiceConfig config;
  Control control;  // closed, unless a test opens it
  HostLine line{&port, clock, std::chrono::milliseconds(5)};
  std::optional<Service> service;
  bool alive = true;
  int kept = 0;
  std::string why_not_kept;
  // Remembers nothing, unless a test gives another.
  std::optional<StopLatch> latch{std::in_place, std::vector<std::string>{}};
  retarget::ExampleMapping profile;  // not used before GivePersonalProfile
  std::vector<wire::Acknowledgement> logged;
  std::vector<std::string> said;  // of the panel

  // The host's side.
  wire::Encoder host_encoder;
  wire::Decoder host_decoder;
  wire::RigCollector host_rig;
  wire::Pose last_pose;
  std::vector<wire::Pose> poses;
  std::vector<Time> pose_times;
  std::vector<wire::Status> statuses;
  std::vector<wire::Acknowledgement> answers;
  std::vector<wire::LandmarkPart> parts;

 private:
  void Receive() {
    const auto& written = port.written();
    ASSERT_LE(written.total() - received_, written.size()) << "more than the fake remembers";
    std::vector<std::byte> fresh;
    for (std::uint64_t i = received_; i < written.total(); ++i) {
      fresh.push_back(written[i - (written.total() - written.size())]);
    }
    received_ = written.total();
    std::span<const std::byte> rest = fresh;
    for (;;) {
      const auto got = host_decoder.Next(rest);
      if (!got) {
        if (got.error() == Errc::kNotReady) return;
        continue;
      }
      host_rig.Add(got->message);
      if (const auto* pose = std::get_if<wire::Pose>(&got->message)) {
        last_pose = *pose;
        poses.push_back(*pose);
        pose_times.push_back(clock.Now());
      } else if (const auto* status = std::get_if<wire::Status>(&got->message)) {
        statuses.push_back(*status);
      } else if (const auto* answer = std::get_if<wire::Acknowledgement>(&got->message)) {
        answers.push_back(*answer);
      } else if (const auto* part = std::get_if<wire::LandmarkPart>(&got->message)) {
        parts.push_back(*part);
      }
    }
  }
  std::uint64_t received_ = 0;
};

}  // namespace facewire::app

#endif  // FACEWIRE_TESTS_APP_SERVICE_CONTEXT_H_
