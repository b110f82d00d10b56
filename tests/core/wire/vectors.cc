#include "tests/core/wire/vectors.h"

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <string>
#include <string_view>

#include "core/wire/encoder.h"
#include "core/wire/pose.h"
#include "core/wire/rig_description.h"
#include "tests/core/wire/test_rig.h"
#include "tests/core/wire/vector_line.h"

namespace facewire::wire {
namespace {

constexpr std::uint32_t kId = 0x1234ABCD;

Pose SomePose(std::size_t channels, std::uint16_t step) {
  Pose pose{.rig_id = kId,
            .frame_seq = 7,
            .captured = Time(Duration(2'000'000)),
            .age_us = 31'000,
            .state = ServiceState::kTracking};
  (void)pose.values.try_resize(channels);
  for (std::uint16_t& v : pose.values) v = step;
  return pose;
}

Pose RampPose(std::size_t channels) {
  Pose pose = SomePose(channels, 0);
  for (std::size_t i = 0; i < channels; ++i) {
    pose.values[i] = static_cast<std::uint16_t>(i * 65535 / (channels - 1));
  }
  return pose;
}

Text SomeText(std::string_view words) {
  Text text{.id = 9};
  (void)text.text.try_resize(words.size());
  std::ranges::copy(words, text.text.begin());
  return text;
}

Message Ping(int id) {
  return Command{.id = static_cast<std::uint16_t>(id), .code = CommandCode::kPing};
}

Bytes Joined(std::initializer_list<Bytes> parts) {
  Bytes out;
  for (const Bytes& part : parts) out = out + part;
  return out;
}

Bytes Cut(Bytes bytes, std::size_t from, std::size_t count) {
  const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(from);
  bytes.erase(first, first + static_cast<std::ptrdiff_t>(count));
  return bytes;
}

Bytes Flipped(Bytes bytes, std::size_t at) {
  bytes[at] ^= std::byte{0x10};
  return bytes;
}

// Payload so that header, payload and CRC are `inside` bytes with no zero among them.
Bytes NoZeroPayload(std::size_t inside, int type, int sequence) {
  for (int fill = 1; fill < 256; ++fill) {
    Bytes payload(inside - kHeaderBytes - kCrcBytes, static_cast<std::byte>(fill));
    // Two delimiters, a code for each begun 254, and no zero anywhere.
    const Bytes frame = RawFrame(kVersion, type, sequence, payload);
    if (frame[1] == static_cast<std::byte>(std::min<std::size_t>(inside, 254) + 1) &&
        frame.size() == MaxFrameBytes(payload.size())) {
      return payload;
    }
  }
  return {};
}

void AddMessages(std::vector<Vector>& all) {
  const auto add = [&](const char* name, const char* about, const Message& message) {
    all.push_back({name, about, Line().Send(message)});
  };
  const ShortName longest = *ShortName::From("abcdefghijklmnopqrstuvwxyz01234");
  add("rig_header", "The counts and the name of a rig",
      RigHeader{.rig_id = kId, .bones = 12, .channels = 31, .name = *ShortName::From("otto")});
  add("rig_header_empty", "A rig of nothing, with no name",
      RigHeader{.rig_id = 0, .bones = 0, .channels = 0, .name = {}});
  add("rig_header_full", "As many bones and channels as there may be, the longest name",
      RigHeader{
          .rig_id = 0xFFFFFFFF, .bones = kMaxBones, .channels = kMaxChannels, .name = longest});
  add("bone", "A bone with its rest position",
      BoneDescription{.rig_id = kId,
                      .index = 3,
                      .name = *ShortName::From("jaw"),
                      .rest_cm = {0.1F, -6.25F, 3.5F}});
  add("bone_last", "The highest index, the longest name, extreme numbers",
      BoneDescription{.rig_id = kId,
                      .index = kMaxBones - 1,
                      .name = longest,
                      .rest_cm = {std::numeric_limits<float>::max(),
                                  std::numeric_limits<float>::denorm_min(), -0.0F}});
  add("channel_rotation", "An angle of bone 3",
      ChannelDescription{.rig_id = kId,
                         .index = 5,
                         .name = *ShortName::From("jaw.pitch"),
                         .kind = ChannelKind::kPitch,
                         .bone = 3,
                         .neutral = 0,
                         .min = -2,
                         .max = 22.5F});
  add("channel_parameter", "A named number of no bone, in its usual range",
      ChannelDescription{.rig_id = kId,
                         .index = kMaxChannels - 1,
                         .name = *ShortName::From("mouthSmileLeft"),
                         .neutral = 0,
                         .min = 0,
                         .max = 1});
  add("channel_fixed", "A channel that cannot move: min = neutral = max; quotes in the name",
      ChannelDescription{.rig_id = kId,
                         .index = 0,
                         .name = *ShortName::From("a\"b\\c"),
                         .kind = ChannelKind::kPositionZ,
                         .bone = 0,
                         .neutral = 4,
                         .min = 4,
                         .max = 4});
  add("pose", "Five channels from the bottom to the top of their ranges", RampPose(5));
  add("pose_empty", "A pose of a rig without channels", SomePose(0, 0));
  add("pose_64", "Sixty-four channels: 161 bytes on the line", RampPose(64));
  add("pose_full", "As many channels as there may be", RampPose(kMaxChannels));
  add("pose_zeros", "Every value at the bottom of its range: zeros, one COBS code each",
      SomePose(32, 0));
  add("pose_ones", "Every value at the top of its range: COBS blocks of 254 bytes",
      SomePose(kMaxChannels, 0xFFFF));
  Pose early = SomePose(1, 0x8000);
  early.captured = Time(Duration(-1));
  early.age_us = 0xFFFFFFFF;
  early.frame_seq = 0xFFFFFFFF;
  early.state = ServiceState::kStopped;
  add("pose_extremes", "A capture before the clock's origin, the oldest age, the last number",
      early);
  add("status", "A status with every field different",
      Status{.rig_id = kId,
             .state = ServiceState::kHolding,
             .now = Time(Duration(123'456'789'012)),
             .uptime_s = 86'400,
             .centi_fps = 2997,
             .frames = 2'589'408,
             .dropped = 17,
             .losses = 5,
             .link_errors = 2,
             .latency_p50_us = 31'250,
             .latency_p99_us = 48'000});
  add("acknowledgement", "A calibration that found no face",
      Acknowledgement{.id = 513,
                      .code = CommandCode::kCalibrateNeutral,
                      .result = CommandResult::kNoFace,
                      .now = Time(Duration(5'000'000))});
  add("acknowledgement_measure", "A calibration that was refused: the head turned by 8.25 degrees",
      Acknowledgement{.id = 514,
                      .code = CommandCode::kCalibrateNeutral,
                      .result = CommandResult::kHeadTurned,
                      .now = Time(Duration(6'000'000)),
                      .measure = 8.25F});
  add("command_value", "Three quarters of the personal profile",
      Command{.id = 7, .code = CommandCode::kBlendProfile, .value = 0.75F});
  add("acknowledgement_not_kept", "A calibration that lasts until the device starts again",
      Acknowledgement{.id = 515,
                      .code = CommandCode::kCalibrateNeutral,
                      .result = CommandResult::kNotKept,
                      .now = Time(Duration(7'000'000))});
  add("text", "Words of an answer", SomeText("no signal \"noSuchSignal\""));
  add("text_empty", "A text without words", SomeText(""));
  add("text_full", "The longest text", SomeText(std::string(kMaxTextBytes, 'x')));
  add("command_reload", "Read the configuration again",
      Command{.id = 9, .code = CommandCode::kReload});
  add("command_move_servo", "The fourth servo to 1500.25 by hand",
      Command{.id = 10, .code = CommandCode::kMoveServo, .value = 1500.25F, .item = 3});
  Line host;
  Bytes commands;
  for (int code = 1; code <= 6; ++code) {
    commands = commands + host.Send(Command{.id = static_cast<std::uint16_t>(code),
                                            .code = static_cast<CommandCode>(code)});
  }
  all.push_back({"commands", "Every command once", commands});

  Line device;
  const Rig rig = TestRig();
  const std::uint32_t id = RigId(rig);
  Bytes session;
  for (std::size_t i = 0; i < DescriptionCount(rig); ++i) {
    session = session + device.Send(*Description(rig, id, i));
  }
  RigPose pose = rig.NeutralPose();
  pose.seq = 100;
  pose.captured = Time(Duration(4'000'000));
  pose.values[0] = std::numeric_limits<float>::quiet_NaN();
  pose.values[1] = 1e9F;
  session = session + device.Send(MakePose(rig, id, pose, ServiceState::kTracking,
                                           Time(Duration(4'025'000))));
  all.push_back({"session",
                 "A whole rig, then a pose of it: channel 0 was not a number and is neutral, "
                 "channel 1 was beyond its range",
                 session});
}

void AddLaterVersions(std::vector<Vector>& all) {
  const auto add = [&](const char* name, const char* about, const Bytes& stream) {
    all.push_back({name, about, stream});
  };
  add("appended_fields", "A command with fields of a later sender after those known: ignored",
      RawFrame(kVersion, 0x80, 0, MakeBytes({1, 0, 1, 9, 9, 9})));
  add("unknown_type",
      "A sound frame of a type that is not known, then a ping: not damage, not lost",
      RawFrame(kVersion, 0x7E, 0, MakeBytes({1, 2, 3})) +
          RawFrame(kVersion, 0x80, 1, MakeBytes({1, 0, 1})));
  add("other_version", "A sound frame of protocol version 2, which this receiver must not read",
      RawFrame(2, 0x80, 0, MakeBytes({1, 0, 1})));
  add("unknown_command", "A command of a later host: delivered, to be answered with unknown",
      RawFrame(kVersion, 0x80, 0, MakeBytes({1, 0, 0xC8})));
  add("unknown_state", "A pose in a state of a later sender: read as fault (7)",
      RawFrame(kVersion, 0x10, 0, Bytes(20, std::byte{0}) + MakeBytes({8, 0})));
  add("unknown_flags", "Servo pulses with flags and a field of a later sender: ignored",
      RawFrame(kVersion, 0x15, 0, MakeBytes({1, 0, 0, 0, 0xFE, 1, 0x70, 0x17, 1, 2, 3})));
  add("unknown_receiver_state",
      "A receiver's status in a state of a later one: read as waiting (0)",
      RawFrame(kVersion, 0x81, 0, MakeBytes({0, 0, 0, 0, 8, 12}) + Bytes(26, std::byte{0})));
  add("unknown_kind", "A channel of a kind of a later sender: read as parameter",
      RawFrame(
          kVersion, 0x03, 0,
          MakeBytes({1, 0, 0, 0, 0, 200, 0xFF}) + Bytes(12, std::byte{0}) + MakeBytes({1, 'x'})));
}

void AddFraming(std::vector<Vector>& all) {
  const auto add = [&](const char* name, const char* about, const Bytes& stream) {
    all.push_back({name, about, stream});
  };
  Line line;
  const Bytes a = line.Send(Ping(1));
  const Bytes b = line.Send(Ping(2));
  const Bytes c = line.Send(Ping(3));
  add("nothing", "No bytes at all", {});
  add("delimiters", "Delimiters around frames, as many as one likes: ignored",
      Joined({Bytes(5, std::byte{0}), a, Bytes(3, std::byte{0}), b}));
  add("shared_delimiter", "Two frames with one delimiter between them: both are sound",
      Cut(a + b, a.size(), 1));
  add("longest_frame", "A frame of 1024 bytes before COBS, of an unknown type: just fits",
      RawFrame(kVersion, 0x7E, 0, Bytes(kMaxPayloadBytes, std::byte{0x55})));
  // The same end of a frame with a block of 253, 254 and 255 bytes.
  for (int inside : {253, 254, 255}) {
    all.push_back({"run_" + std::to_string(inside),
                   std::to_string(inside) + " bytes before COBS and no zero among them",
                   RawFrame(kVersion, 0x7E, 0x0101,
                            NoZeroPayload(static_cast<std::size_t>(inside), 0x7E, 0x0101))});
  }
  Bytes redundant = RawFrame(kVersion, 0x7E, 0x0101, NoZeroPayload(254, 0x7E, 0x0101));
  redundant.insert(redundant.end() - 1, std::byte{0x01});
  add("run_254_redundant",
      "As run_254 with the code 01 that some encoders append after a full block: the same frame",
      redundant);
  const Bytes ping = MakeBytes({1, 0, 1});
  add("numbers_wrap", "After 65535 comes 1: nothing is lost",
      RawFrame(kVersion, 0x80, 65534, ping) + RawFrame(kVersion, 0x80, 65535, ping) +
          RawFrame(kVersion, 0x80, 1, ping));
  add("numbers_gap", "Three frames never came, across the wrap",
      RawFrame(kVersion, 0x80, 65534, ping) + RawFrame(kVersion, 0x80, 3, ping));
  add("numbers_far", "32767 frames never came, across the wrap: still a gap; one more is a restart",
      RawFrame(kVersion, 0x80, 50000, ping) + RawFrame(kVersion, 0x80, 17233, ping) +
          RawFrame(kVersion, 0x80, 50002, ping));
  add("restart", "0 is the first frame of a sender that started again: nothing is lost",
      RawFrame(kVersion, 0x80, 900, ping) + RawFrame(kVersion, 0x80, 0, ping));
  add("restart_unseen", "A number from behind is a restart whose first frame did not arrive",
      RawFrame(kVersion, 0x80, 900, ping) + RawFrame(kVersion, 0x80, 1, ping));
  add("join_mid_stream", "The end of a frame whose beginning nobody saw is not damage",
      Joined({Cut(a, 0, 6), b, c}));
}

void AddDamage(std::vector<Vector>& all) {
  const auto add = [&](const char* name, const char* about, const Bytes& stream) {
    all.push_back({name, about, stream});
  };
  Line line;
  const Bytes a = line.Send(Ping(1));
  const Bytes b = line.Send(Ping(2));
  const Bytes c = line.Send(Ping(3));
  const Bytes garbage = MakeBytes({0xDE, 0xAD, 0xBE, 0xEF});
  add("bad_crc", "One bit of the middle frame is wrong", Joined({a, Flipped(b, b.size() - 2), c}));
  add("cut_start", "The middle frame lacks its first bytes, the delimiter included",
      Joined({a, Cut(b, 0, 4), c}));
  add("cut_end", "The middle frame lacks its last bytes, the delimiter included; the next is sound",
      Joined({a, Cut(b, b.size() - 4, 4), c}));
  add("cut_middle", "The middle frame lacks bytes in its middle", Joined({a, Cut(b, 4, 3), c}));
  add("glued", "Both delimiters between two frames are missing: both frames are lost",
      Joined({a, Cut(b + c, b.size() - 1, 2), line.Send(Ping(4))}));
  add("garbage_between", "Bytes of noise between two frames: nothing is lost",
      Joined({a, garbage, b}));
  add("garbage_before", "Noise before the first delimiter, such as a boot loader's: not damage",
      garbage + a);
  add("too_short", "Sound COBS, too short for header and CRC",
      Joined({a, MakeBytes({3, 1, 2, 0}), b}));
  add("overlong", "1025 bytes before COBS, CRC right: longer than any frame may be",
      Joined({a, RawFrame(kVersion, 0x7E, 1, Bytes(kMaxPayloadBytes + 1, std::byte{0x55})), c}));
  add("unfinished", "A frame that has not ended is not delivered",
      Joined({a, Cut(b, b.size() - 1, 1)}));

  const auto malformed = [&](const char* name, const char* about, int type, const Bytes& payload) {
    add(name, about, RawFrame(kVersion, type, 0, payload));
  };
  malformed("malformed_short", "A command without its code", 0x80, MakeBytes({1, 0}));
  malformed("malformed_text", "A text that promises four bytes and holds three", 0x13,
            MakeBytes({1, 0, 4, 0, 65, 66, 67}));
  malformed("malformed_text_long", "A text that promises more than a text may hold", 0x13,
            MakeBytes({1, 0, 0xE1, 1}) + Bytes(481, std::byte{65}));
  malformed("malformed_value", "A blend without its value", 0x80, MakeBytes({1, 0, 7}));
  malformed("malformed_value_nan", "A blend that is not a number", 0x80,
            MakeBytes({1, 0, 7, 0, 0, 0xC0, 0x7F}));
  malformed("malformed_pose_short", "A pose that promises two values and holds one", 0x10,
            Bytes(20, std::byte{0}) + MakeBytes({2, 2, 0x11, 0x22}));
  malformed("malformed_pose_count", "A pose of 241 channels", 0x10,
            Bytes(20, std::byte{0}) + MakeBytes({2, 241}) + Bytes(482, std::byte{0x11}));
  malformed("malformed_name", "A bone whose name has a space", 0x02,
            Bytes(17, std::byte{0}) + MakeBytes({3, 'a', ' ', 'b'}));
  malformed("malformed_name_long", "A name of 32 characters", 0x01,
            MakeBytes({1, 0, 0, 0, 0, 0, 32}) + Bytes(32, std::byte{'a'}));
  malformed("malformed_bones", "A rig of 81 bones", 0x01, MakeBytes({1, 0, 0, 0, 81, 0, 0}));
  malformed("malformed_nan", "A rest position that is not a number", 0x02,
            Bytes(5, std::byte{0}) + MakeBytes({0, 0, 0xC0, 0x7F}) + Bytes(9, std::byte{0}));
  malformed("malformed_range", "A channel whose min (1) is above its max (0)", 0x03,
            MakeBytes({1, 0, 0, 0, 0, 0, 0xFF}) + Bytes(4, std::byte{0}) +
                MakeBytes({0, 0, 0x80, 0x3F}) + Bytes(5, std::byte{0}));
}

// What a bad line makes of it: one byte in `one_in` has a wrong bit, is missing, has a stray one
// before it, or is a delimiter. The numbers of std::mt19937 are the same everywhere.
Bytes Noisy(const Bytes& bytes, std::uint32_t one_in) {
  std::mt19937 random(20);
  Bytes out;
  for (std::byte b : bytes) {
    const auto hit = static_cast<std::uint32_t>(random());
    const auto bit = static_cast<std::byte>(1U << ((hit >> 16U) & 7U));
    switch (hit % one_in) {
      case 0:
        out.push_back(b ^ bit);
        break;
      case 1:
        break;
      case 2:
        out.push_back(bit);
        out.push_back(b);
        break;
      case 3:
        out.push_back(std::byte{0});
        break;
      default:
        out.push_back(b);
    }
  }
  return out;
}

void AddBadLine(std::vector<Vector>& all) {
  Line line;
  Bytes stream;
  const BoneDescription bone{.rig_id = kId, .index = 3, .name = *ShortName::From("jaw")};
  for (int round = 0; round < 12; ++round) {
    for (const Message& message :
         {Message(Acknowledgement{}), Message(RampPose(9)), Message(Status{}), Message(bone)}) {
      stream = stream + line.Send(message);
    }
  }
  all.push_back({"bad_line", "A line that damages one byte in 40, in each of the ways it can",
                 Noisy(stream, 160)});
}

}  // namespace

std::vector<Vector> AllVectors() {
  std::vector<Vector> all;
  AddMessages(all);
  AddLaterVersions(all);
  AddFraming(all);
  AddDamage(all);
  AddBadLine(all);
  AddServos(all);
  AddLandmarks(all);
  return all;
}

}  // namespace facewire::wire
