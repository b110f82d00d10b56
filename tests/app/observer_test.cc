// What feeds the watchdog, and what systemd and the journal hear: the service on fakes, systemd a
// socket of the test's own.

#include "app/observer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "tests/app/notified.h"
#include "tests/app/service_context.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

class Watched : public testing::Test, public ServiceContext {
 public:
  Watched() {
    ::setenv("NOTIFY_SOCKET", systemd.path().c_str(), 1);
    ::setenv("WATCHDOG_USEC", "10000000", 1);
    ::unsetenv("WATCHDOG_PID");
    supervisor = std::make_unique<Supervisor>();
    ::unsetenv("NOTIFY_SOCKET");
    ::unsetenv("WATCHDOG_USEC");
    observer = std::make_unique<Observer>(journal, *supervisor, *latch);
    testing::internal::CaptureStderr();
  }
  ~Watched() override { (void)Journaled(); }
  // How often the watchdog was fed in that time of the service's own clock.
  int BeatsWithin(Duration time) {
    heard.clear();
    for (const Time end = clock.Now() + time; clock.Now() < end;) {
      Tick();
      observer->Look(*service, clock.Now());
      heard += systemd.Heard();  // a socket holds few messages
    }
    return BeatsIn(heard);
  }
  std::string heard;  // in that time
  std::string Journaled() {
    if (read_) return "";
    read_ = true;
    return testing::internal::GetCapturedStderr();
  }

  Notified systemd;
  Journal journal{"/no/journal"};
  std::unique_ptr<Supervisor> supervisor;
  std::unique_ptr<Observer> observer;

 private:
  bool read_ = false;
};

TEST_F(Watched, IsFedTwicePerIntervalWhileAFaceIsFollowed) {
  BringToTracking();
  EXPECT_GE(BeatsWithin(seconds(50)), 10);
}

TEST_F(Watched, IsFedWhileTheSearchFindsNobody) { EXPECT_GE(BeatsWithin(seconds(100)), 20); }

TEST_F(Watched, IsFedWhileStopped) {
  BringToTracking();
  stop.Hold(true);
  EXPECT_GE(BeatsWithin(seconds(50)), 10);
}

TEST_F(Watched, IsFedWhileCameraAndLineAreUnplugged) {
  BringToTracking();
  camera.Unplug();
  EXPECT_GE(BeatsWithin(seconds(50)), 10);
  port.Unplug();
  EXPECT_GE(BeatsWithin(seconds(50)), 10);
  EXPECT_THAT(Journaled(), HasSubstr("facewired: fault: the camera is gone\n"));
}

TEST_F(Watched, StarvesWhenTheCameraOpensButStaysSilent) {
  BringToTracking();
  camera.FallSilent();
  (void)BeatsWithin(seconds(10));
  EXPECT_EQ(BeatsWithin(seconds(100)), 0);
  camera.Resume();
  EXPECT_GE(BeatsWithin(seconds(50)), 7) << "it was not restarted, and is well again";
  const std::string journaled = Journaled();
  EXPECT_THAT(journaled, HasSubstr("the watchdog is not fed\n"));
  EXPECT_THAT(journaled, HasSubstr("the watchdog is fed again\n"));
}

TEST_F(Watched, StarvesWhenTheLineIsOpenButTakesNothing) {
  BringToTracking();
  port.AcceptOnly(0);
  (void)BeatsWithin(seconds(12));
  EXPECT_EQ(BeatsWithin(seconds(100)), 0);
  port.AcceptAll();
  EXPECT_GE(BeatsWithin(seconds(50)), 9);
}

TEST_F(Watched, StarvesWhenTheLoopHangs) {
  BringToTracking();
  (void)BeatsWithin(seconds(10));
  clock.SleepUntil(clock.Now() + seconds(100));
  EXPECT_EQ(BeatsIn(systemd.Heard()), 0) << "nobody ticks, nobody looks";
}

TEST_F(Watched, TellsHowLongTheStartTookOnceAndStatesWithTheirReasons) {
  (void)BeatsWithin(seconds(10));
  EXPECT_GT(observer->searching_after(), Duration::zero());
  camera.Unplug();
  (void)BeatsWithin(seconds(10));
  EXPECT_THAT(heard, HasSubstr("STATUS=fault: the camera is gone, 0.0 fps"));
  camera.Plug();
  (void)BeatsWithin(seconds(20));
  const std::string journaled = Journaled();
  EXPECT_THAT(journaled, testing::ContainsRegex("facewired: searching after [0-9.]+ s\n"));
  EXPECT_EQ(journaled.find("searching after"), journaled.rfind("searching after"));
  EXPECT_THAT(journaled, HasSubstr("fault: the camera is gone\n"));
}

}  // namespace
}  // namespace facewire::app
