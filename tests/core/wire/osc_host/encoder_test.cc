#include "core/wire/osc_host/encoder.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "core/wire/osc/reader.h"
#include "core/wire/osc/slip.h"
#include "core/wire/osc_host/address.h"
#include "core/wire/osc_host/command.h"

namespace facewire::wire::osc_host {
namespace {

// A message as a person would write it, but for its numbers: "/facewire/rig ,siii".
struct Context {
  template <class M>
  std::string Said(const M& message) {
    const auto frame = Encode(message, std::span<std::byte>(out));
    if (!frame) return Name(frame.error());
    std::span<const std::byte> line = *frame;
    const auto packet = slip.Next(line);
    auto reader = osc::Reader::Of(packet.value());
    if (!reader) return Name(reader.error());
    const auto view = reader->Next();
    arguments.assign(reinterpret_cast<const char*>(view->arguments.data()), view->arguments.size());
    return std::string(view->address) + " ," + std::string(view->types);
  }
  std::array<std::byte, osc::MaxSlipBytes(kMaxPacketBytes)> out{};
  std::array<std::byte, kMaxPacketBytes> memory{};
  osc::SlipDecoder slip{memory};
  std::string arguments;
};

ShortName NameOf(const char* text) { return *ShortName::From(text); }

TEST(OscHostEncoder, EachMessageHasItsAddressAndItsTypes) {
  Context c;
  EXPECT_EQ(c.Said(RigHeader{.rig_id = 1, .bones = 2, .channels = 3, .name = NameOf("otto")}),
            "/facewire/rig ,siii");
  EXPECT_EQ(c.Said(BoneDescription{.name = NameOf("jaw")}), "/facewire/bone ,isfff");
  EXPECT_EQ(c.Said(ChannelDescription{.name = NameOf("jaw.pitch"), .kind = ChannelKind::kPitch}),
            "/facewire/channel ,isfffs");
  EXPECT_NE(c.arguments.find("/face/jaw/pitch"), std::string::npos);
  EXPECT_NE(c.arguments.find("deg"), std::string::npos);
  EXPECT_EQ(c.Said(Status{.state = ServiceState::kTracking}), "/facewire/status ,sfiiiiiff");
  EXPECT_TRUE(c.arguments.starts_with("tracking"));
  EXPECT_EQ(c.Said(Acknowledgement{.code = CommandCode::kCalibrateNeutral,
                                   .result = CommandResult::kHeadTurned,
                                   .measure = 12}),
            "/facewire/answer ,ssf");
  EXPECT_TRUE(c.arguments.starts_with("calibrate_neutral"));
  EXPECT_NE(c.arguments.find("head_turned"), std::string::npos);
}

TEST(OscHostEncoder, TheLongestNamesFit) {
  Context c;
  const ShortName name = NameOf("abcdefghijklmnopqrstuvwxyz12345");
  EXPECT_EQ(name.view().size(), kMaxNameLength);
  EXPECT_EQ(c.Said(RigHeader{.name = name}), "/facewire/rig ,siii");
  EXPECT_EQ(c.Said(ChannelDescription{.name = name, .kind = ChannelKind::kPositionX}),
            "/facewire/channel ,isfffs");
}

TEST(OscHostEncoder, WhatHasNoPlaceInOscIsNotSaid) {
  Context c;
  EXPECT_EQ(c.Said(Message(Text{})), Name(Errc::kUnsupported));
  EXPECT_EQ(c.Said(Message(RigHeader{})), "/facewire/rig ,siii");
}

TEST(OscHostAddress, OfABoneHasTheBoneAsItsFolder) {
  EXPECT_EQ(ValueAddress(NameOf("jawOpen"), ChannelKind::kParameter).view(), "/face/jawOpen");
  EXPECT_EQ(ValueAddress(NameOf("neck.yaw"), ChannelKind::kYaw).view(), "/face/neck/yaw");
  EXPECT_EQ(ValueAddress(NameOf("lid.up.L.x"), ChannelKind::kPositionX).view(), "/face/lid.up.L/x");
  EXPECT_EQ(ValueAddress(NameOf("my.own"), ChannelKind::kParameter).view(), "/face/my.own");
}

TEST(OscHostAddress, HasNothingThatOscReadsAsAPattern) {
  EXPECT_EQ(ValueAddress(NameOf("a/b*c?d[e]{f},#"), ChannelKind::kParameter).view(),
            "/face/a_b_c_d_e__f___");
}

}  // namespace
}  // namespace facewire::wire::osc_host
