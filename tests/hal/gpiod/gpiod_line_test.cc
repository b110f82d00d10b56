#include "hal/gpiod/gpiod_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/hal/gpiod/fake_chips.h"
#include "tests/support/allocation_counter.h"

namespace facewire::hal::gpiod {
namespace {

using testing::HasSubstr;

constexpr const char* kPi = "/dev/gpiochip0";

// A board with two chips, whose lines 0 to 3 are named.
struct Board {
  Board() {
    chips.AddChip("gpiochip0", "pinctrl-bcm2711", {"ID_SDA", "GPIO1", "GPIO2", "LED"});
    chips.AddChip("gpiochip1", "raspberrypi-exp-gpio", {"BT_ON", "", "LED"});
  }
  Result<> Open(GpiodConfig config) {
    GpiodInput line(std::move(config), chips);
    const Result<> opened = line.Open();
    reason = line.reason();
    return opened;
  }
  FakeChips chips;
  std::string reason;
};

TEST(GpiodLine, IsFoundByLabelNameOrPathOfItsChipAndByItsOwnName) {
  Board b;
  for (const LineName& name :
       {LineName{"pinctrl-bcm2711", "2"}, LineName{"gpiochip0", "2"}, LineName{kPi, "2"},
        LineName{"", "GPIO2"}, LineName{kPi, "GPIO2"}, LineName{"gpiochip1", "LED"}}) {
    EXPECT_TRUE(b.Open({.name = name})) << name.chip << ' ' << name.line << ": " << b.reason;
    EXPECT_EQ(b.reason, "");
  }
}

TEST(GpiodLine, SaysWhatThereIsWhenSomethingIsNotThere) {
  Board b;
  EXPECT_EQ(b.Open({.name = {"pinctrl-rp1", "17"}}).error(), Errc::kNotFound);
  EXPECT_EQ(b.reason,
            "there is no GPIO chip \"pinctrl-rp1\"; this machine has: gpiochip0 "
            "(pinctrl-bcm2711), gpiochip1 (raspberrypi-exp-gpio)");
  EXPECT_EQ(b.Open({.name = {"/dev/gpiochip7", "17"}}).error(), Errc::kNotFound);
  EXPECT_EQ(b.reason, "there is no GPIO chip /dev/gpiochip7");
  EXPECT_EQ(b.Open({.name = {"gpiochip0", "4"}}).error(), Errc::kNotFound);
  EXPECT_EQ(b.reason, "gpiochip0 (pinctrl-bcm2711) has no line 4, only 0 to 3");
  EXPECT_EQ(b.Open({.name = {"gpiochip0", "BT_ON"}}).error(), Errc::kNotFound);
  EXPECT_EQ(b.reason, "no line is called \"BT_ON\" on gpiochip0 (pinctrl-bcm2711)");
  b.chips.chips.clear();
  EXPECT_EQ(b.Open({.name = {"", "GPIO1"}}).error(), Errc::kNotFound);
  EXPECT_EQ(b.reason, "this machine has no GPIO chip");
}

TEST(GpiodLine, DoesNotGuessBetweenLinesThatFitAlike) {
  Board b;
  EXPECT_EQ(b.Open({.name = {"", "LED"}}).error(), Errc::kInvalidArgument);
  EXPECT_THAT(b.reason, HasSubstr("several lines are called \"LED\""));
  EXPECT_EQ(b.Open({.name = {"", "2"}}).error(), Errc::kInvalidArgument);
  b.chips.AddChip("gpiochip2", "pinctrl-bcm2711", {"X"});
  EXPECT_EQ(b.Open({.name = {"pinctrl-bcm2711", "0"}}).error(), Errc::kInvalidArgument);
  EXPECT_THAT(b.reason, HasSubstr("several GPIO chips are called \"pinctrl-bcm2711\""));
}

TEST(GpiodLine, SaysWhoHoldsALineThatIsBusy) {
  Board b;
  b.chips.At(kPi, 3).held = true;
  b.chips.chips[0].lines[3] = {"LED", true, "led0"};
  EXPECT_EQ(b.Open({.name = {kPi, "3"}}).error(), Errc::kBusy);
  EXPECT_THAT(b.reason, HasSubstr("line \"LED\", 3 of gpiochip0"));
  EXPECT_THAT(b.reason, HasSubstr("is in use by \"led0\""));
}

TEST(GpiodLine, TwoHoldersOfOneLineExcludeEachOther) {
  Board b;
  auto first = std::make_unique<GpiodInput>(GpiodConfig{.name = {kPi, "1"}}, b.chips);
  GpiodInput second({.name = {kPi, "1"}}, b.chips);
  ASSERT_TRUE(first->Open());
  ASSERT_TRUE(first->Open()) << "a line that is held stays as it is";
  EXPECT_EQ(second.Open().error(), Errc::kBusy);
  first.reset();
  EXPECT_TRUE(second.Open());
}

TEST(GpiodLine, ForbiddenChipsAndLinesArePermission) {
  Board b;
  b.chips.describe_errors[kPi] = EACCES;
  EXPECT_EQ(b.Open({.name = {kPi, "1"}}).error(), Errc::kPermission);
  EXPECT_THAT(b.reason, HasSubstr("no permission to open /dev/gpiochip0"));
  EXPECT_EQ(b.Open({.name = {"pinctrl-bcm2711", "1"}}).error(), Errc::kPermission)
      << "it may be the chip that cannot be read";
  b.chips.describe_errors.clear();
  b.chips.take_error = EPERM;
  EXPECT_EQ(b.Open({.name = {kPi, "1"}}).error(), Errc::kPermission);
}

TEST(GpiodLine, ABiasThatTheChipCannotDoIsUnsupported) {
  Board b;
  for (const int error : {EINVAL, EOPNOTSUPP, 524}) {
    b.chips.take_error = error;
    EXPECT_EQ(b.Open({.name = {kPi, "1"}, .bias = Bias::kPullUp}).error(), Errc::kUnsupported);
    EXPECT_THAT(b.reason, HasSubstr("cannot pull it up; put a resistor there"));
    EXPECT_EQ(b.Open({.name = {kPi, "1"}}).error(), Errc::kUnsupported);
    EXPECT_THAT(b.reason, HasSubstr("cannot be an input"));
  }
  b.chips.take_error = 0;
  b.chips.describe_errors[kPi] = ENOTTY;
  EXPECT_EQ(b.Open({.name = {kPi, "1"}}).error(), Errc::kUnsupported);
  EXPECT_EQ(b.reason, "/dev/gpiochip0 is not a GPIO chip");
}

TEST(GpiodLine, AChipThatGoesIsDisconnectedUntilTheLineIsTakenAgain) {
  Board b;
  GpiodInput line({.name = {"pinctrl-bcm2711", "1"}}, b.chips);
  EXPECT_EQ(line.Get().error(), Errc::kDisconnected);
  EXPECT_EQ(line.reason(), "the line is not open");
  ASSERT_TRUE(line.Open());
  b.chips.use_error = ENODEV;
  EXPECT_EQ(line.Get().error(), Errc::kDisconnected);
  EXPECT_EQ(line.reason(), "the GPIO chip has gone");
  b.chips.use_error = 0;
  EXPECT_EQ(line.Get().error(), Errc::kDisconnected) << "it was another chip's line";
  b.chips.chips.clear();
  EXPECT_EQ(line.Open().error(), Errc::kNotFound);
  b.chips.AddChip("gpiochip5", "pinctrl-bcm2711", {"", ""});  // back, under another number
  ASSERT_TRUE(line.Open());
  EXPECT_EQ(line.Get(), false);
}

TEST(GpiodLine, AnyOtherFailureKeepsTheLine) {
  Board b;
  GpiodInput line({.name = {kPi, "1"}}, b.chips);
  ASSERT_TRUE(line.Open());
  b.chips.use_error = ETIME;
  EXPECT_EQ(line.Get().error(), Errc::kIo);
  b.chips.use_error = 0;
  EXPECT_EQ(line.Get(), false);
}

TEST(GpiodInput, AsksForItsPolarityAndBias) {
  Board b;
  GpiodInput line({.name = {kPi, "1"}, .active_low = true, .bias = Bias::kPullUp}, b.chips);
  ASSERT_TRUE(line.Open());
  const FakeChips::Line& taken = b.chips.At(kPi, 1);
  EXPECT_FALSE(taken.settings.output);
  EXPECT_TRUE(taken.settings.active_low);
  EXPECT_EQ(taken.settings.bias, Bias::kPullUp);
}

TEST(GpiodOutput, BeginsAndEndsAtTheSafeLevel) {
  Board b;
  FakeChips::Line& wire = b.chips.At(kPi, 2);
  wire.asserted = true;  // as somebody left it
  {
    GpiodOutput line({.name = {kPi, "2"}, .active_low = true, .bias = Bias::kPullUp}, b.chips);
    ASSERT_TRUE(line.Open());
    EXPECT_FALSE(wire.asserted);
    EXPECT_TRUE(wire.settings.output);
    EXPECT_EQ(wire.settings.bias, Bias::kAsIs) << "nothing to hold: it is driven";
    ASSERT_TRUE(line.Set(true));
    EXPECT_TRUE(wire.asserted);
  }
  EXPECT_FALSE(wire.asserted);
  EXPECT_FALSE(wire.held);
}

TEST(GpiodLine, OffsetsAreDigitsAndNothingElse) {
  EXPECT_EQ(OffsetOf("17"), 17U);
  EXPECT_EQ(OffsetOf("0"), 0U);
  for (const char* text : {"", "GPIO17", "17x", "-1", "+1", " 1", "99999999999"}) {
    EXPECT_EQ(OffsetOf(text), std::nullopt) << text;
  }
}

TEST(GpiodLine, ReadingAndSettingAllocateNothing) {
  using facewire::test::AllocationCounter;
  if (!AllocationCounter::kAvailable) GTEST_SKIP() << AllocationCounter::kWhyNot;
  Board b;
  GpiodInput in({.name = {kPi, "1"}}, b.chips);
  GpiodOutput out({.name = {kPi, "2"}}, b.chips);
  ASSERT_TRUE(in.Open());
  ASSERT_TRUE(out.Open());
  AllocationCounter counter;
  counter.Arm();
  const Result<bool> level = in.Get();
  const Result<> set = out.Set(true);
  b.chips.use_error = EIO;
  const Result<> failed = out.Set(true);
  counter.Disarm();
  EXPECT_TRUE(level && set && !failed);
  EXPECT_EQ(counter.allocations(), 0U);
}

}  // namespace
}  // namespace facewire::hal::gpiod
