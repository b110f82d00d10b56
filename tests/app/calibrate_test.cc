// facewire calibrate and facewire blend as an operator runs them, against a service on real sockets
// and pseudo-terminals with a generated performer before its camera. The service's clock is a fake:
// its ten seconds pass while the tool waits for a moment.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "hal/pty/pty_host.h"
#include "tests/app/performer.h"
#include "tests/app/process.h"
#include "tests/app/scratch.h"
#include "tests/app/service_context.h"

namespace facewire::app {
namespace {

using ::testing::HasSubstr;

struct Ran {
  int code = -1;
  std::string out, err;
};

class Stage : public ServiceContext {
 public:
  Stage() {
    follower.face = StillPerformer();
    EXPECT_TRUE(control.Open(socket()));
    EXPECT_TRUE(line_.Open());
  }
  std::string socket() const { return scratch_ / "control"; }
  const std::string& pty() const { return pty_.device_path(); }

  // `facewire ARGUMENTS`, while the service runs and follows the performer.
  Ran Facewire(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), FACEWIRE_TOOL);
    Service running(config,
                    {.camera = camera,
                     .line = line_,
                     .clock = clock,
                     .follower = follower,
                     .capture = capture,
                     .control = &control,
                     .keep_neutral =
                         [this](const retarget::Neutral&) {
                           ++kept;
                           return why_not_kept;
                         }},
                    character);
    follower.failure = Errc::kNoFace;
    for (int i = 0; i < 20; ++i) running.Tick();
    follower.failure.reset();
    while (running.state() != ServiceState::kTracking) running.Tick();
    Process process(arguments, scratch_ / "out", scratch_ / "err");
    std::atomic<int> code = -2;
    std::jthread waiting([&] { code = process.Wait(); });
    while (code == -2) {
      running.Tick();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));  // 30 times faster than life
    }
    return {.code = code, .out = process.out(), .err = process.err()};
  }

 private:
  Scratch scratch_;
  hal::pty::PtyHost pty_;
  HostLine line_{&pty_, clock, std::chrono::milliseconds(5)};
};

TEST(Calibrate, TakesTheNeutralOfAPerformerWhoHoldsStillOverTheSocketAndOverALine) {
  Stage stage;
  for (const std::string& where : {stage.socket(), stage.pty()}) {
    const Ran ran = stage.Facewire({"calibrate", where});
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(ran.out, "the neutral was taken, and is kept\n");
    EXPECT_EQ(ran.err, "");
  }
  EXPECT_EQ(stage.kept, 2);
}

TEST(Calibrate, SaysInOneSentenceWhyItWasRefused) {
  Stage stage;
  stage.follower.act = ShakeHead;
  const Ran shook = stage.Facewire({"calibrate", stage.socket()});
  EXPECT_EQ(shook.code, 1);
  EXPECT_THAT(shook.err, testing::MatchesRegex(
                             "facewire: hold still: the head turned by [0-9]+ degrees within the "
                             "second\n"));
  stage.follower.act = BlinkTwiceASecond;
  const Ran blinked = stage.Facewire({"calibrate", stage.pty()});
  EXPECT_EQ(blinked.code, 1);
  EXPECT_THAT(blinked.err, HasSubstr("facewire: do not blink: "));
  EXPECT_EQ(stage.kept, 0);
  stage.follower.act = [](FacePose& face) { face.points_cm[14].y -= 2; };
  EXPECT_THAT(stage.Facewire({"calibrate", stage.socket()}).err, HasSubstr("close the mouth"));
}

TEST(Blend, SetsThePartOrSaysThatThereIsNothingToBlend) {
  Stage stage;
  const Ran refused = stage.Facewire({"blend", "100", stage.pty()});
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.err, HasSubstr("no personal profile"));
  stage.GivePersonalProfile();
  const Ran set = stage.Facewire({"blend", "75", stage.socket()});
  EXPECT_EQ(set.code, 0) << set.err;
  EXPECT_EQ(stage.character.retargeter.blend(), 0.75F);
}

TEST(Calibrate, RefusesBadUsageWithOneLine) {
  const Scratch scratch;
  scratch.Write("file", "text");
  const std::vector<std::pair<std::vector<std::string>, std::string>> table = {
      {{"calibrate", scratch / "nobody"}, "no service is at"},
      {{"calibrate", scratch / "file"}, "is not a serial line"},
      {{"calibrate", "--timeout", "-1"}, "--timeout"},
      {{"blend", "101"}, "PERCENT"},
      {{"blend", "lots"}, "PERCENT"},
      {{"blend"}, "PERCENT"},
  };
  for (const auto& [arguments, complaint] : table) {
    std::vector<std::string> command = arguments;
    command.insert(command.begin(), FACEWIRE_TOOL);
    Process process(command, scratch / "out", scratch / "err");
    EXPECT_EQ(process.Wait(), 2) << arguments[0] << process.err();
    EXPECT_THAT(process.err(), HasSubstr(complaint));
    EXPECT_EQ(std::ranges::count(process.err(), '\n'), 1) << process.err();
    EXPECT_EQ(process.out(), "");
  }
}

TEST(Calibrate, GivesUpOnALineWhereNobodyAnswers) {
  const Scratch scratch;
  hal::pty::PtyHost silent;
  ASSERT_TRUE(silent.Open());
  Process process({FACEWIRE_TOOL, "calibrate", silent.device_path(), "--timeout", "0.2"},
                  scratch / "out", scratch / "err");
  EXPECT_EQ(process.Wait(), 1);
  EXPECT_THAT(process.err(), HasSubstr("nothing answers within 0.2 s"));
}

}  // namespace
}  // namespace facewire::app
