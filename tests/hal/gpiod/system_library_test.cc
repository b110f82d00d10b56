// The linked libgpiod on a chip of the kernel's simulator (gpio-sim), whose lines are driven and
// seen from outside through sysfs. The environment names it:
//   FACEWIRE_TEST_GPIO=LABEL,FOLDER
// LABEL is the chip's label; FOLDER holds the lines' own folders, sim_gpio0 and so on, with the
// files `pull` and `value`: /sys/devices/platform/gpio-sim.0/gpiochip0, for instance. At least two
// lines are needed, and nobody else may use the first two.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "hal/gpiod/gpiod_line.h"
#include "tests/support/allocation_counter.h"

namespace facewire::hal::gpiod {
namespace {

using testing::HasSubstr;

TEST(SystemLibrary, WhatIsNoGpioChipIsUnsupportedAndWhatIsNotThereIsNotFound) {
  GpiodInput null({.name = {"/dev/null", "0"}});
  EXPECT_EQ(null.Open().error(), Errc::kUnsupported);
  EXPECT_EQ(null.reason(), "/dev/null is not a GPIO chip");
  GpiodInput none({.name = {"/dev/gpiochip-of-nobody", "0"}});
  EXPECT_EQ(none.Open().error(), Errc::kNotFound);
  GpiodInput nowhere({.name = {"a label that no chip has", "0"}});
  EXPECT_FALSE(nowhere.Open());
}

class SimulatedChip : public testing::Test {
 protected:
  void SetUp() override {
    const char* variable = std::getenv("FACEWIRE_TEST_GPIO");
    const std::string text = variable == nullptr ? "" : variable;
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos) {
      GTEST_SKIP() << "needs a chip of gpio-sim: FACEWIRE_TEST_GPIO=LABEL,FOLDER";
    }
    label_ = text.substr(0, comma);
    folder_ = text.substr(comma + 1);
  }
  GpiodConfig Line(int offset, bool active_low = false, Bias bias = Bias::kAsIs) const {
    return {{label_, std::to_string(offset)}, active_low, bias};
  }
  // "pull-up" or "pull-down": the level of an input.
  void Pull(int offset, const char* pull) const {
    std::ofstream file(File(offset, "pull"));
    file << pull << std::flush;
    ASSERT_TRUE(file) << File(offset, "pull");
  }
  // "0" or "1", as a voltmeter shows it.
  std::string Value(int offset) const { return Read(offset, "value"); }
  std::string Pulled(int offset) const { return Read(offset, "pull"); }
  const std::string& label() const { return label_; }

 private:
  std::string File(int offset, const char* name) const {
    return folder_ + "/sim_gpio" + std::to_string(offset) + "/" + name;
  }
  std::string Read(int offset, const char* name) const {
    std::ifstream file(File(offset, name));
    std::string text;
    EXPECT_TRUE(std::getline(file, text)) << File(offset, name);
    return text;
  }

  std::string label_;
  std::string folder_;
};

TEST_F(SimulatedChip, AnInputFollowsItsWireInEitherPolarity) {
  for (const bool active_low : {false, true}) {
    GpiodInput line(Line(0, active_low));
    ASSERT_TRUE(line.Open()) << line.reason();
    Pull(0, "pull-up");
    EXPECT_EQ(line.Get(), !active_low);
    Pull(0, "pull-down");
    EXPECT_EQ(line.Get(), active_low);
  }
}

TEST_F(SimulatedChip, ABiasHoldsALineThatNothingDrives) {
  Pull(0, "pull-down");
  GpiodInput up(Line(0, false, Bias::kPullUp));
  ASSERT_TRUE(up.Open()) << up.reason();
  EXPECT_EQ(Pulled(0), "pull-up");
  EXPECT_EQ(up.Get(), true);
  GpiodInput down(Line(1, false, Bias::kPullDown));
  ASSERT_TRUE(down.Open()) << down.reason();
  EXPECT_EQ(Pulled(1), "pull-down");
  EXPECT_EQ(down.Get(), false);
}

TEST_F(SimulatedChip, AnOutputDrivesItsWireInEitherPolarityAndBeginsAndEndsSafely) {
  for (const bool active_low : {false, true}) {
    const std::string safe = active_low ? "1" : "0";
    const std::string asserted = active_low ? "0" : "1";
    {
      GpiodOutput line(Line(0, active_low));
      ASSERT_TRUE(line.Open()) << line.reason();
      EXPECT_EQ(Value(0), safe);
      ASSERT_TRUE(line.Set(true));
      EXPECT_EQ(Value(0), asserted);
      ASSERT_TRUE(line.Set(false));
      EXPECT_EQ(Value(0), safe);
      ASSERT_TRUE(line.Set(true));
    }
    // What a released line shows is the chip's own affair (here: its pull).
    GpiodOutput again(Line(0, active_low));
    ASSERT_TRUE(again.Open()) << again.reason();
    EXPECT_EQ(Value(0), safe);
  }
}

TEST_F(SimulatedChip, ALineThatSomebodyHoldsIsBusyAndSaysWho) {
  GpiodInput first(Line(1));
  ASSERT_TRUE(first.Open());
  GpiodOutput second(Line(1));
  EXPECT_EQ(second.Open().error(), Errc::kBusy);
  EXPECT_THAT(std::string(second.reason()), HasSubstr("is in use by \"facewire\""));
}

TEST_F(SimulatedChip, AProcessThatDiesLeavesTheLineToTheNext) {
  const pid_t child = fork();
  if (child == 0) {
    GpiodOutput line(Line(0));
    if (line.Open() && line.Set(true)) raise(SIGKILL);
    _exit(1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  RecordProperty("value_after_kill", Value(0));
  std::printf("after SIGKILL the line's value is %s\n", Value(0).c_str());
  GpiodOutput next(Line(0));
  ASSERT_TRUE(next.Open()) << next.reason();
  EXPECT_EQ(Value(0), "0") << "taking it makes it safe";
}

TEST_F(SimulatedChip, ReadingAndSettingAllocateNothing) {
  using facewire::test::AllocationCounter;
  if (!AllocationCounter::kAvailable) GTEST_SKIP() << AllocationCounter::kWhyNot;
  GpiodInput in(Line(0));
  GpiodOutput out(Line(1));
  ASSERT_TRUE(in.Open());
  ASSERT_TRUE(out.Open());
  AllocationCounter counter;
  counter.Arm();
  const Result<bool> level = in.Get();
  const Result<> set = out.Set(true);
  counter.Disarm();
  counter.PrintFirst();
  EXPECT_TRUE(level && set);
  EXPECT_EQ(counter.allocations(), 0U);
  EXPECT_EQ(counter.frees(), 0U);
}

TEST_F(SimulatedChip, IsListedWithItsLines) {
  bool found = false;
  for (const std::string& path : SystemLibrary().Chips()) {
    const auto chip = SystemLibrary().Describe(path);
    if (chip && chip->label == label()) {
      found = true;
      EXPECT_GE(chip->lines.size(), 2U);
      EXPECT_EQ(chip->path, "/dev/" + chip->name);
    }
  }
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace facewire::hal::gpiod
