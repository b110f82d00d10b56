#include "core/wire/osc_host/command.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "core/wire/osc/osc.h"

namespace facewire::wire::osc_host {
namespace {

using namespace std::string_view_literals;  // NOLINT(google-build-using-namespace): a literal

using Bytes = std::vector<std::byte>;

Bytes OnTheLine(std::span<const std::byte> packet) {
  Bytes out(osc::MaxSlipBytes(packet.size()));
  out.resize(osc::Slip(packet, out)->size());
  return out;
}

template <class... Args>
Bytes Packet(std::string_view address, const Args&... args) {
  std::array<std::byte, kMaxPacketBytes> memory{};
  osc::Writer packet(memory);
  EXPECT_TRUE(packet.Message(address, args...));
  return {packet.bytes().begin(), packet.bytes().end()};
}

struct Context {
  std::vector<Command> Take(std::span<const std::byte> bytes) {
    std::vector<Command> commands;
    for (;;) {
      const auto command = decoder.Next(bytes);
      if (command) commands.push_back(*command);
      if (!command && command.error() == Errc::kNotReady) return commands;
    }
  }
  template <class... Args>
  std::vector<Command> Say(std::string_view address, const Args&... args) {
    return Take(OnTheLine(Packet(address, args...)));
  }
  CommandDecoder decoder;
};

TEST(OscCommand, EachHasAnAddress) {
  for (const auto& [address, code] :
       {std::pair{"/facewire/ping", CommandCode::kPing},
        std::pair{"/facewire/describe", CommandCode::kDescribeRig},
        std::pair{"/facewire/calibrate", CommandCode::kCalibrateNeutral},
        std::pair{"/facewire/neutral", CommandCode::kRest},
        std::pair{"/facewire/stop", CommandCode::kStop},
        std::pair{"/facewire/release", CommandCode::kRelease}}) {
    Context c;
    const auto commands = c.Say(address);
    ASSERT_EQ(commands.size(), 1U) << address;
    EXPECT_EQ(commands[0].code, code) << address;
    EXPECT_EQ(c.decoder.stats().frames, 1U);
  }
}

TEST(OscCommand, AButtonIsPressedWithOneAndLetGoWithZero) {
  Context c;
  EXPECT_EQ(c.Say("/facewire/release", std::int32_t{1}).size(), 1U);
  EXPECT_EQ(c.Say("/facewire/release", 1.0F).size(), 1U);
  EXPECT_TRUE(c.Say("/facewire/release", std::int32_t{0}).empty());
  EXPECT_TRUE(c.Say("/facewire/release", 0.5F).empty());
}

TEST(OscCommand, ABlendTakesItsValue) {
  Context c;
  const auto commands = c.Say("/facewire/blend", 0.25F);
  ASSERT_EQ(commands.size(), 1U);
  EXPECT_EQ(commands[0].value, 0.25F);
  EXPECT_TRUE(c.Say("/facewire/blend").empty());
  EXPECT_TRUE(c.Say("/facewire/blend", NAN).empty());
}

TEST(OscCommand, OtherArgumentsAndOtherAddressesAreNoCommands) {
  Context c;
  EXPECT_TRUE(c.Say("/facewire/release", "now"sv).empty());
  EXPECT_TRUE(c.Say("/facewire/release", std::int32_t{1}, std::int32_t{1}).empty());
  EXPECT_EQ(c.decoder.stats().malformed, 2U);
  EXPECT_TRUE(c.Say("/facewire/releases").empty());
  EXPECT_TRUE(c.Say("/facewire/*").empty());
  EXPECT_EQ(c.decoder.stats().unknown, 2U);
}

TEST(OscCommand, EachOfABundleIsObeyed) {
  std::array<std::byte, kMaxPacketBytes> memory{};
  osc::Writer bundle(memory);
  ASSERT_TRUE(bundle.Bundle());
  ASSERT_TRUE(bundle.Message("/facewire/ping"));
  ASSERT_TRUE(bundle.Message("/facewire/blend", 1.0F));
  Context c;
  const auto commands = c.Take(OnTheLine(bundle.bytes()));
  ASSERT_EQ(commands.size(), 2U);
  EXPECT_EQ(commands[1].code, CommandCode::kBlendProfile);
}

TEST(OscCommand, AStopIsObeyedWhateverElseIsWrongWithItsPacket) {
  const Bytes stop = Packet("/facewire/stop", std::int32_t{0});
  for (std::size_t size = std::string_view("/facewire/stop").size(); size <= stop.size(); ++size) {
    Context c;
    const auto commands = c.Take(OnTheLine(std::span(stop).first(size)));
    ASSERT_EQ(commands.size(), 1U) << size;
    EXPECT_EQ(commands[0].code, CommandCode::kStop);
  }
  // Behind the rest of a packet whose end was lost, and in a bundle that ends too early.
  Context c;
  Bytes joined = Packet("/facewire/ping");
  joined.resize(7);
  joined.insert(joined.end(), stop.begin(), stop.end());
  EXPECT_EQ(c.Take(OnTheLine(joined)).size(), 1U);
}

TEST(OscCommand, AReleaseIsObeyedOnlyWhenItIsExact) {
  const Bytes release = Packet("/facewire/release");
  for (std::size_t i = 0; i < release.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      Bytes damaged = release;
      damaged[i] ^= static_cast<std::byte>(1 << bit);
      Context c;
      EXPECT_TRUE(c.Take(OnTheLine(damaged)).empty()) << i;
    }
    Context c;
    EXPECT_TRUE(
        c.Take(OnTheLine(std::span(release).first(i + 1 == release.size() ? i : i + 1))).empty());
  }
  Bytes longer = release;
  longer.push_back(std::byte{0});
  Context c;
  EXPECT_TRUE(c.Take(OnTheLine(longer)).empty());
  EXPECT_GT(c.decoder.stats().Damaged(), 0U);
}

// Of any number of packets with any damage none becomes another command than a stop.
TEST(OscCommand, DamageNeverMakesACommand) {
  const std::array packets = {Packet("/facewire/ping", std::int32_t{1}),
                              Packet("/facewire/neutral"), Packet("/facewire/calibrate"),
                              Packet("/facewire/stop")};
  std::mt19937 dice(3);
  int stops = 0;
  Context c;
  for (int round = 0; round < 100'000; ++round) {
    Bytes line = OnTheLine(packets[dice() % packets.size()]);
    for (auto changes = 1 + dice() % 6; changes > 0; --changes) {
      // Not the argument's last byte: a number of 1 is as good as a bare address.
      line[dice() % (line.size() - 1)] = static_cast<std::byte>(dice() % 256);
    }
    for (const Command& command : c.Take(line)) {
      EXPECT_NE(command.code, CommandCode::kRelease);
      stops += command.code == CommandCode::kStop ? 1 : 0;
    }
  }
  EXPECT_GT(stops, 100);
  EXPECT_GT(c.decoder.stats().Damaged(), 1000U);
  (void)c.Take(OnTheLine(Packet("/x")));  // the end of what was open
  EXPECT_EQ(c.Say("/facewire/release").size(), 1U) << "and the next is obeyed";
}

TEST(OscCommand, NoiseIsNoCommand) {
  std::mt19937 dice(4);
  Context c;
  Bytes noise(1000);
  for (int round = 0; round < 300; ++round) {
    for (std::byte& b : noise) b = static_cast<std::byte>(dice() % 256);
    EXPECT_TRUE(c.Take(noise).empty());
  }
  EXPECT_GT(c.decoder.stats().Damaged(), 100U);
}

}  // namespace
}  // namespace facewire::wire::osc_host
