// What is kept, when the disk fails or the power goes at the worst moment: at every one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/checked_file.h"
#include "app/error.h"
#include "app/neutral_file.h"
#include "app/stop_latch.h"
#include "tests/app/fake_disk.h"
#include "tests/app/scratch.h"

namespace facewire::app {
namespace {

using ::testing::HasSubstr;

retarget::Neutral SomeNeutral(float depth_cm) {
  retarget::Neutral neutral;
  neutral.count = 30;
  for (std::size_t i = 0; i < neutral.count; ++i) {
    neutral.points_cm[i] = {static_cast<float>(i), 1, depth_cm};
  }
  return neutral;
}

constexpr const char* kPath = "state/performer.neutral";

std::string FileOf(const retarget::Neutral& neutral) {
  FakeDisk disk;
  SaveNeutral(kPath, neutral, disk);
  return disk.Seen().at(kPath);
}

TEST(NeutralFile, IsTheOldOneOrTheNewOneWheneverThePowerGoes) {
  const std::string old_file = FileOf(SomeNeutral(3));
  const std::string new_file = FileOf(SomeNeutral(7));
  ASSERT_NE(old_file, new_file);
  bool finished = false;
  int moments = 0;
  for (; !finished; ++moments) {
    FakeDisk disk;
    disk.Hold(kPath, old_file);
    disk.LosePowerBefore(moments);
    try {
      SaveNeutral(kPath, SomeNeutral(7), disk);
      finished = disk.calls() <= moments;
    } catch (const Failure&) {
    }
    for (const FakeDisk::Files& found : disk.Survivors()) {
      ASSERT_TRUE(found.contains(kPath)) << "power lost before call " << moments;
      const std::string& file = found.at(kPath);
      ASSERT_TRUE(file == new_file || (file == old_file && !finished))
          << "power lost before call " << moments << ": " << file.size() << " bytes";
    }
  }
  EXPECT_GE(moments, 8) << "there are so many steps at least";
}

TEST(NeutralFile, StaysTheOldOneWithoutARestWhenTheDiskIsFullOrFailsAtAnyStep) {
  const std::string old_file = FileOf(SomeNeutral(3));
  for (const int error : {ENOSPC, EROFS, EIO, EDQUOT}) {
    bool finished = false;
    for (int step = 0; !finished; ++step) {
      FakeDisk disk;
      disk.Hold(kPath, old_file);
      disk.FailAt(step, error);
      std::string why;
      try {
        SaveNeutral(kPath, SomeNeutral(7), disk);
        finished = disk.calls() <= step;
      } catch (const Failure& e) {
        why = e.what();
      }
      if (why.empty()) continue;
      EXPECT_THAT(why, HasSubstr(std::strerror(error))) << step;
      EXPECT_THAT(why, HasSubstr("state")) << "it names the place";
      EXPECT_EQ(disk.Seen().size(), 1U) << "nothing half-written is left after step " << step;
    }
  }
}

class LatchOnFakeDisk {
 public:
  FakeDisk disk;
  StopLatch latch{{"/var", "/run"}, disk};
};

TEST(StopLatch, OutlastsALossOfPowerFromTheMomentThatItSaysSo) {
  bool finished = false;
  for (int moment = 0; !finished; ++moment) {
    LatchOnFakeDisk l;
    l.disk.LosePowerBefore(moment);
    finished = l.latch.Engage();
    if (!finished) continue;
    for (const FakeDisk::Files& found : l.disk.Survivors()) {
      ASSERT_TRUE(found.contains("/var/stopped")) << moment;
    }
  }
}

TEST(StopLatch, IsNotForgottenByALossOfPowerInTheMiddleOfAReleaseThatWasNotAnswered) {
  bool finished = false;
  for (int moment = 0; !finished; ++moment) {
    LatchOnFakeDisk l;
    ASSERT_TRUE(l.latch.Engage());
    l.disk.LosePowerBefore(moment);
    finished = l.latch.Release();
    if (!finished) continue;
    for (const FakeDisk::Files& found : l.disk.Survivors()) {
      ASSERT_FALSE(found.contains("/var/stopped")) << "released is released";
    }
  }
}

TEST(StopLatch, FallsBackToTheRuntimeFolderWhenTheDiskIsReadOnlyOrFull) {
  for (const int error : {EROFS, ENOSPC, EACCES, ENOENT}) {
    LatchOnFakeDisk l;
    l.disk.FailAt(0, error);
    EXPECT_FALSE(l.latch.Engage()) << "it does not outlast a loss of power";
    EXPECT_THAT(l.latch.reason(),
                HasSubstr(std::string("/var/stopped: cannot be made: ") + std::strerror(error)));
    EXPECT_TRUE(l.disk.Seen().contains("/run/stopped"));
    StopLatch restarted({"/var", "/run"}, l.disk);
    EXPECT_TRUE(restarted.Engaged()) << "but a restart";
    EXPECT_TRUE(restarted.Release());
    EXPECT_FALSE(restarted.Engaged());
    EXPECT_TRUE(l.disk.Seen().empty());
  }
}

TEST(StopLatch, SaysWhenNothingKeepsIt) {
  LatchOnFakeDisk l;
  l.disk.ReadOnly();
  EXPECT_FALSE(l.latch.Engage());
  EXPECT_THAT(l.latch.reason(), HasSubstr("/var/stopped"));
  EXPECT_THAT(l.latch.reason(), HasSubstr("/run/stopped"));
  EXPECT_TRUE(l.latch.Release()) << "there is nothing that could come back";
  StopLatch none({"", ""}, l.disk);
  EXPECT_TRUE(none.Engage());
  EXPECT_FALSE(none.Engaged());
}

TEST(StopLatch, StaysWhenItCannotBeRemovedFromEveryPlace) {
  LatchOnFakeDisk l;
  l.disk.Hold("/var/stopped", "");
  l.disk.Hold("/run/stopped", "");
  l.disk.FailAt(0, EROFS);
  EXPECT_FALSE(l.latch.Release());
  EXPECT_THAT(l.latch.reason(), HasSubstr("/var/stopped: cannot be removed: Read-only"));
  EXPECT_TRUE(l.latch.Engaged());
  l.disk.Repair();
  EXPECT_TRUE(l.latch.Release());
  EXPECT_FALSE(l.latch.Engaged());
}

TEST(StopLatch, CountsAsEngagedWhenItCannotBeLookedAt) {
  LatchOnFakeDisk l;
  l.disk.FailAt(0, EIO);
  EXPECT_TRUE(l.latch.Engaged());
  EXPECT_THAT(l.latch.reason(), HasSubstr("cannot be looked at"));
  for (const int absent : {ENOENT, ENOTDIR}) {
    l.disk.FailAt(0, absent);
    EXPECT_FALSE(l.latch.Engaged());
  }
}

TEST(StopLatch, TakesAnEmptyFileFromADiskWithoutRoomForItsContent) {
  LatchOnFakeDisk l;
  l.disk.FailAt(1, ENOSPC);  // the write behind the opening
  EXPECT_TRUE(l.latch.Engage());
  EXPECT_EQ(l.disk.Seen().at("/var/stopped"), "");
  EXPECT_TRUE(l.latch.Engaged());
}

TEST(StopLatch, WorksOnTheRealFileSystem) {
  const Scratch scratch;
  StopLatch latch({(scratch / "no folder").string(), scratch.folder().string()});
  EXPECT_FALSE(latch.Engaged());
  EXPECT_FALSE(latch.Engage());
  EXPECT_TRUE(std::filesystem::exists(scratch / "stopped"));
  EXPECT_TRUE(latch.Engaged());
  EXPECT_TRUE(latch.Release());
  EXPECT_FALSE(std::filesystem::exists(scratch / "stopped"));
}

}  // namespace
}  // namespace facewire::app
