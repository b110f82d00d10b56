// The service through crashes, stops, full disks and hangs: the real programs, real footage, a host
// at a pseudo-terminal.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <thread>

#include "core/wire/pose.h"
#include "hal/posix/raw_mode.h"
#include "hal/posix/unique_fd.h"
#include "tests/app/facewired.h"
#include "tests/app/notified.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::Not;
using S = ServiceState;

constexpr const char* kControl = "[control]\nsocket = \"control\"\n";

struct Ran {
  int code = -1;
  std::string out, err;
};

// `facewire VERB`, while the host listens.
Ran Verb(const Facewired& f, Listener& host, std::vector<std::string> arguments) {
  arguments.push_back((f.scratch / "control").string());
  Process tool = Tool(f, arguments);
  std::optional<int> code;
  std::jthread waiting([&] { code = tool.Wait(); });
  EXPECT_TRUE(host.Until([&] { return code.has_value(); }));
  return {code.value_or(-1), tool.out(), tool.err()};
}

bool AtNeutral(const wire::Pose& pose, const Rig& rig) {
  const RigPose values = wire::ValuesOf(pose, rig);
  for (std::size_t i = 0; i < values.count; ++i) {
    const Channel& channel = rig.channels[i];
    if (std::abs(values.values[i] - channel.neutral) > 1e-3F * (channel.max - channel.min)) {
      return false;
    }
  }
  return true;
}

TEST(Life, BeginsAtNeutralAfterACrash) {
  Facewired f(Configuration());
  {
    Process process = f.Start({"--fake"});
    Listener host(f.scratch / "line");
    ASSERT_TRUE(host.Until([&] {
      return host.state() == S::kTracking && host.rig.Complete() &&
             !AtNeutral(host.poses.back(), host.rig.rig());
    })) << process.err();
    f.Crash(process);
  }
  Process again = f.Start({"--fake"});
  Listener host(f.scratch / "line");
  ASSERT_TRUE(host.Until([&] { return host.rig.Complete() && host.poses.size() > 20; }))
      << again.err();
  EXPECT_EQ(host.poses.front().state, S::kStarting);
  for (const wire::Pose& pose : host.poses) {
    if (pose.state == S::kTracking) break;
    ASSERT_TRUE(AtNeutral(pose, host.rig.rig()));
  }
}

TEST(Life, StaysStoppedThroughACrashUntilItIsReleased) {
  Facewired f(Configuration(kControl));
  {
    Process process = f.Start({"--fake"});
    Listener host(f.scratch / "line");
    ASSERT_TRUE(host.Until([&] { return host.state() == S::kTracking; })) << process.err();
    const Ran stop = Verb(f, host, {"stop"});
    EXPECT_EQ(stop.code, 0) << stop.err;
    EXPECT_EQ(stop.out, "stopped, over restarts too; `facewire release` ends it\n");
    EXPECT_EQ(host.state(), S::kStopped);
    f.Crash(process);
  }
  Process again = f.Start({"--fake"});
  Listener host(f.scratch / "line");
  ASSERT_TRUE(host.Until([&] { return host.poses.size() > 30; })) << again.err();
  EXPECT_EQ(std::ranges::count(host.poses, S::kStopped, &wire::Pose::state),
            static_cast<std::ptrdiff_t>(host.poses.size()));
  EXPECT_THAT(again.err(), HasSubstr("an emergency stop from before the start still holds"));
  EXPECT_THAT(Verb(f, host, {"status"}).out, HasSubstr("stopped: remembered from before"));
  const Ran release = Verb(f, host, {"release"});
  EXPECT_EQ(release.code, 0) << release.err;
  EXPECT_TRUE(host.Until([&] { return host.state() == S::kTracking; }));
  EXPECT_FALSE(std::filesystem::exists(f.scratch / "state/stopped"));
}

TEST(Life, GoesToNeutralAndBackOnCommandAndSaysHowItFares) {
  Facewired f(Configuration(kControl));
  Process process = f.Start({"--fake"});
  Listener host(f.scratch / "line");
  ASSERT_TRUE(host.Until([&] { return host.state() == S::kTracking; })) << process.err();
  EXPECT_EQ(Verb(f, host, {"neutral"}).code, 0);
  EXPECT_TRUE(host.Until([&] { return host.state() == S::kSearching; }));
  EXPECT_TRUE(AtNeutral(host.poses.back(), host.rig.rig()));
  EXPECT_EQ(Verb(f, host, {"release"}).code, 0);
  EXPECT_TRUE(host.Until([&] { return host.state() == S::kTracking; }));
  const std::size_t statuses = host.statuses.size();
  ASSERT_TRUE(host.Until([&] { return host.statuses.size() > statuses + 1; }));

  const Ran text = Verb(f, host, {"status"});
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("\ncamera   replay:"));
  EXPECT_THAT(text.out, HasSubstr("line: up, "));
  EXPECT_THAT(text.out, Not(HasSubstr("?")));
  std::printf("%s", text.out.c_str());  // memory, threads, and how soon it searched
  std::fflush(stdout);
  const Ran json = Verb(f, host, {"status", "--json"});
  EXPECT_EQ(json.code, 0) << json.err;
  EXPECT_EQ(std::ranges::count(json.out, '\n'), 1);
  EXPECT_THAT(json.out, HasSubstr("\"line_state\":\"up\""));
  EXPECT_THAT(json.out, HasSubstr("\"camera_state\":\"up\""));
  EXPECT_THAT(json.out, Not(HasSubstr("\"searching_after_s\":0.00")));
  EXPECT_THAT(json.out, Not(HasSubstr("\"resident_bytes\":0,")));
}

TEST(Life, ReloadsOnCommandOrNamesEveryMistake) {
  const std::string good = Configuration(kControl);
  Facewired f(good);
  Process process = f.Start({"--fake"});
  Listener host(f.scratch / "line");
  ASSERT_TRUE(host.Until([&] { return host.state() == S::kTracking; })) << process.err();
  f.scratch.Write("facewire.toml", good + "[nonsense]\n[pose]\nvertical_fov_deg = 900\n");
  const Ran bad = Verb(f, host, {"reload"});
  EXPECT_EQ(bad.code, 1);
  EXPECT_THAT(bad.err, HasSubstr("not reloaded, running on as before:\n"));
  EXPECT_THAT(bad.err, HasSubstr("nonsense"));
  EXPECT_THAT(bad.err, HasSubstr("vertical_fov_deg"));
  EXPECT_GE(std::ranges::count(process.err(), '\n'), 3) << "an entry each: " << process.err();
  EXPECT_THAT(process.err(), HasSubstr("facewired: " + (f.scratch / "facewire.toml").string()));
  f.scratch.Write("facewire.toml", "[camera\n");
  EXPECT_EQ(Verb(f, host, {"reload"}).code, 1);
  std::filesystem::remove(f.scratch / "facewire.toml");
  EXPECT_EQ(Verb(f, host, {"reload"}).code, 1);
  EXPECT_NE(host.state(), S::kFault);
  f.scratch.Write("facewire.toml", good);
  EXPECT_EQ(Verb(f, host, {"reload"}).code, 0);
  EXPECT_TRUE(host.Until([&] { return host.state() == S::kTracking; })) << "it runs on";
}

TEST(Life, NeedsNoDiskButSaysWhatItCannotKeep) {
  Facewired f(Configuration("[control]\nsocket = \"run/control\"\n"));
  std::filesystem::create_directory(f.scratch / "run");
  f.scratch.Write("state", "a file where the folder should be");
  const auto tool = [&](Listener& host, const char* verb) {
    Process process = Tool(f, {verb, (f.scratch / "run/control").string()});
    std::optional<int> code;
    std::jthread waiting([&] { code = process.Wait(); });
    EXPECT_TRUE(host.Until([&] { return code.has_value(); }));
    return Ran{code.value_or(-1), process.out(), process.err()};
  };
  {
    Process process = f.Start({"--fake"});
    Listener host(f.scratch / "line");
    ASSERT_TRUE(host.Until([&] { return host.state() == S::kTracking; })) << process.err();
    EXPECT_THAT(process.err(), HasSubstr("neither a neutral nor an emergency stop will outlast"));
    const Ran calibrate = tool(host, "calibrate");
    EXPECT_EQ(calibrate.code, 0) << calibrate.err;
    EXPECT_THAT(calibrate.out, HasSubstr("is kept only until the restart: "));
    EXPECT_THAT(calibrate.out, HasSubstr("state"));
    EXPECT_THAT(tool(host, "status").out, HasSubstr("\nstorage  nothing outlasts"));
    const Ran stop = tool(host, "stop");
    EXPECT_EQ(stop.code, 0) << stop.err;
    EXPECT_THAT(stop.out, HasSubstr("stopped, but a restart may forget it: "));
    EXPECT_TRUE(std::filesystem::exists(f.scratch / "run/stopped"));
    f.Crash(process);
  }
  Process again = f.Start({"--fake"});
  Listener host(f.scratch / "line");
  EXPECT_TRUE(host.Until([&] { return host.state() == S::kStopped; }))
      << "systemd keeps that one: " << again.err();
  EXPECT_EQ(tool(host, "release").code, 0);
  EXPECT_TRUE(host.Until([&] { return host.state() == S::kTracking; }));
}

TEST(Life, StarvesTheWatchdogWhenItHangs) {
  Facewired f(Configuration());
  Notified systemd;
  Process process =
      f.Start({"--fake"}, {{"NOTIFY_SOCKET", systemd.path()}, {"WATCHDOG_USEC", "200000"}});
  ASSERT_TRUE(systemd.Until("WATCHDOG=1")) << process.err();
  process.Signal(SIGSTOP);
  (void)systemd.Heard();
  EXPECT_FALSE(systemd.Until("WATCHDOG=1", seconds(2)));
  process.Signal(SIGCONT);
  EXPECT_TRUE(systemd.Until("WATCHDOG=1"));
}

TEST(Life, StarvesTheWatchdogWhenTheLineTakesNothing) {
  const hal::posix::UniqueFd master(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC));
  std::array<char, 64> name;
  ASSERT_EQ(::grantpt(master.get()), 0);
  ASSERT_EQ(::unlockpt(master.get()), 0);
  ASSERT_EQ(::ptsname_r(master.get(), name.data(), name.size()), 0);
  ASSERT_TRUE(hal::posix::SetRaw(master.get()));
  Facewired f(Replaced(Configuration(), "line = \"pty:line\"",
                       "line = \"serial:" + std::string(name.data()) + "\"\nstuck_after_s = 1"));
  Notified systemd;
  Process process = f.Start({}, {{"NOTIFY_SOCKET", systemd.path()}, {"WATCHDOG_USEC", "200000"}});
  ASSERT_TRUE(systemd.Until("WATCHDOG=1")) << process.err();
  ASSERT_TRUE(systemd.Until("the line is open but takes no bytes"));
  (void)systemd.Heard();
  EXPECT_FALSE(systemd.Until("WATCHDOG=1", seconds(2)));
  EXPECT_THAT(process.err(), HasSubstr("the watchdog is not fed\n"));
}

TEST(Life, SaysThatNoServiceIsThere) {
  const Facewired f("");
  for (const char* verb : {"status", "neutral", "stop", "release", "reload"}) {
    Process tool = Tool(f, {verb, (f.scratch / "control").string()});
    EXPECT_EQ(tool.Wait(), 2) << verb;
    EXPECT_THAT(tool.err(), HasSubstr("no service is at ")) << verb;
    EXPECT_EQ(tool.out(), "") << verb;
  }
}

}  // namespace
}  // namespace facewire::app
