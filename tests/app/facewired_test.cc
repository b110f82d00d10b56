// The program as its users meet it: started with real footage and networks, listened to over a
// pseudo-terminal, asked by signals.

#include "tests/app/facewired.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <thread>

#include "app/profile_file.h"
#include "core/wire/pose.h"
#include "tests/app/notified.h"

namespace facewire::app {
namespace {

using ::testing::HasSubstr;

TEST(Facewired, FollowsFootageOnAPseudoTerminalAndEndsAtNeutral) {
  Facewired f(Configuration());
  Process process =
      f.Start({"--fake", "--seconds", "4", "--stats-json", (f.scratch / "stats.json").string()});
  Listener host(f.scratch / "line");
  EXPECT_TRUE(host.Until([&] { return host.hung_up; }));
  EXPECT_EQ(process.Wait(), 0) << process.err();
  ASSERT_TRUE(host.rig.Complete());
  EXPECT_EQ(host.rig.rig().name.view(), "otto");
  EXPECT_EQ(host.stats().Damaged(), 0U);
  EXPECT_GE(host.statuses.size(), 3U);
  EXPECT_GE(std::ranges::count(host.poses, ServiceState::kTracking, &wire::Pose::state), 20);
  ASSERT_GE(host.poses.size(), 10U);
  const RigPose last = wire::ValuesOf(host.poses.back(), host.rig.rig());
  for (std::size_t i = 0; i < last.count; ++i) {
    const Channel& channel = host.rig.rig().channels[i];
    EXPECT_NEAR(last.values[i], channel.neutral, 1e-3 * (channel.max - channel.min))
        << channel.name.view();
  }
  const std::string stats = ReadAll(f.scratch / "stats.json");
  EXPECT_THAT(stats, HasSubstr("\"frames\": "));
  EXPECT_THAT(stats, HasSubstr("\"resident_bytes\": "));
  EXPECT_THAT(process.out(), HasSubstr("latency p50"));
  EXPECT_FALSE(std::filesystem::exists(f.scratch / "line")) << "the link goes with the program";
}

TEST(Facewired, EndsWithTheRecordingWhenItDoesNotLoop) {
  Facewired f("[camera]\ndevice = \"replay\"\n[camera.replay]\nfile = \"" FACEWIRE_ASSETS
              "/footage/franck.mp4\"\nmemory_mib = 16\npace = \"fast\"\n[tracker]\n"
              "networks = \"" FACEWIRE_ASSETS "/networks\"\n[character]\nrig = \"" +
              std::string(kRig) + "\"\nprofile = \"" + kProfile +
              "\"\n[neutral]\nfolder = \"state\"\n[host]\nline = \"none\"\n");
  Process process = f.Start();
  EXPECT_EQ(process.Wait(), 0) << process.err();
  EXPECT_THAT(process.out(), HasSubstr("0 dropped"));
}

TEST(Facewired, EasesToNeutralOnSigterm) {
  Facewired f(Configuration());
  Process process = f.Start({"--fake"});
  Listener host(f.scratch / "line");
  ASSERT_TRUE(host.Until([&] { return host.state() == ServiceState::kTracking; })) << process.err();
  process.Signal(SIGTERM);
  EXPECT_TRUE(host.Until([&] { return host.hung_up; }));
  EXPECT_EQ(process.Wait(), 0);
  EXPECT_EQ(host.state(), ServiceState::kEasing);
  EXPECT_GE(std::ranges::count(host.poses, ServiceState::kEasing, &wire::Pose::state), 10);
}

TEST(Facewired, ReloadsOnSighupAndKeepsTheOldRigWhenTheNewOneIsBad) {
  Facewired f(Configuration("", "rig.toml"));
  const std::string rig = ReadAll(kRig);
  f.scratch.Write("rig.toml", rig);
  Process process = f.Start({"--fake"});
  Listener host(f.scratch / "line");
  ASSERT_TRUE(host.Until([&] { return host.rig.Complete() && !host.poses.empty(); }))
      << process.err();
  const std::uint32_t first = host.poses.back().rig_id;

  f.scratch.Write("rig.toml", rig + "\n[[parameter]]\nname = \"noSuchSignal\"\n");
  process.Signal(SIGHUP);
  EXPECT_TRUE(host.Until([&] { return process.err().find("not reloaded") != std::string::npos; }));
  EXPECT_THAT(process.err(), HasSubstr("no signal \"noSuchSignal\""));
  const std::size_t before = host.poses.size();
  ASSERT_TRUE(host.Until([&] { return host.poses.size() > before + 3; })) << "it runs on";
  EXPECT_EQ(host.poses.back().rig_id, first);

  f.scratch.Write("rig.toml", rig + "\n[[parameter]]\nname = \"glow\"\ndrive = { jawOpen = 1 }\n");
  process.Signal(SIGHUP);
  ASSERT_TRUE(host.Until([&] { return host.poses.back().rig_id != first; })) << process.err();
  ASSERT_TRUE(host.Until(
      [&] { return host.rig.Complete() && host.rig.rig_id() == host.poses.back().rig_id; }));
  EXPECT_TRUE(host.rig.rig().FindChannel("glow"));
  ASSERT_TRUE(host.Until([&] { return host.state() == ServiceState::kTracking; }));
  process.Signal(SIGTERM);
  EXPECT_EQ(process.Wait(), 0);
}

TEST(Facewired, TakesAndKeepsANeutralOnCommandAcrossARestartAndACrash) {
  Facewired f(Configuration("[control]\nsocket = \"control\"\n"));
  const std::filesystem::path file = f.scratch / "state/performer.neutral";
  {
    Process process = f.Start({"--fake"});
    Listener host(f.scratch / "line");
    ASSERT_TRUE(host.Until([&] { return host.state() == ServiceState::kTracking; }))
        << process.err();
    // The performer of this recording talks and blinks, and sits still in between.
    Process calibrate = Tool(f, {"calibrate", (f.scratch / "control").string()});
    std::optional<int> code;
    std::jthread waiting([&] { code = calibrate.Wait(); });
    EXPECT_TRUE(host.Until([&] { return std::filesystem::exists(file); }));
    waiting.join();
    EXPECT_EQ(code, 0) << calibrate.err();
    EXPECT_EQ(calibrate.out(), "the neutral was taken, and is kept\n");
    f.Crash(process);
  }
  EXPECT_TRUE(std::filesystem::exists(f.scratch / "control")) << "it had no time to clear up";
  const std::string kept = ReadAll(file);
  // A crash in the middle of writing leaves a part beside the file, and the file as it was.
  f.scratch.Write("state/performer.neutral.XXXXXX", kept.substr(0, kept.size() / 2));
  {
    Process again = f.Start({"--fake"});
    Listener host(f.scratch / "line");
    ASSERT_TRUE(host.Until([&] { return host.state() == ServiceState::kTracking; })) << again.err();
    EXPECT_THAT(again.err(), testing::Not(HasSubstr("taking a new neutral")));
    EXPECT_THAT(again.err(), testing::Not(HasSubstr("control socket")))
        << "the old one is replaced";
    EXPECT_EQ(ReadAll(file), kept);
    Process blend = Tool(f, {"blend", "50", (f.scratch / "control").string()});
    EXPECT_EQ(blend.Wait(), 1);
    EXPECT_THAT(blend.err(), HasSubstr("no personal profile"));
    again.Signal(SIGTERM);
    EXPECT_EQ(again.Wait(), 0);
  }
  EXPECT_FALSE(std::filesystem::exists(f.scratch / "control")) << "removed at the end";
  // And a file that is damaged all the same does not keep the board from starting.
  f.scratch.Write("state/performer.neutral", kept.substr(0, kept.size() / 2));
  Process third = f.Start({"--fake", "--seconds", "0.5"});
  EXPECT_EQ(third.Wait(), 0);
  EXPECT_THAT(third.err(), HasSubstr("taking a new neutral"));
}

TEST(Facewired, RefusesToServeASocketThatAnotherOneServes) {
  const std::string control = "[control]\nsocket = \"control\"\n";
  Facewired f(Configuration(control));
  Process first = f.Start({"--fake"});
  Listener host(f.scratch / "line");
  ASSERT_TRUE(host.Until([&] { return !host.poses.empty(); })) << first.err();
  Process second({FACEWIRED, "--fake", "--config", (f.scratch / "facewire.toml").string()},
                 f.scratch / "out2", f.scratch / "err2");
  EXPECT_EQ(second.Wait(), 2);
  EXPECT_THAT(second.err(), HasSubstr("another facewired serves this control socket"));
  Process calibrate = Tool(f, {"calibrate", (f.scratch / "control").string(), "--timeout", "0.1"});
  EXPECT_EQ(calibrate.Wait(), 1);
  EXPECT_TRUE(std::filesystem::exists(f.scratch / "control")) << "the first one still serves";
}

TEST(Facewired, RunsWithoutAControlSocketWhereThereCanBeNone) {
  Facewired f(Configuration("[control]\nsocket = \"no/folder/control\"\n"));
  Process process = f.Start({"--fake", "--seconds", "0.5"});
  EXPECT_EQ(process.Wait(), 0);
  EXPECT_THAT(process.err(), HasSubstr("running without the control socket"));
  EXPECT_THAT(process.err(), HasSubstr("its folder does not exist"));
}

TEST(Facewired, TellsSystemdHowItFares) {
  Facewired f(Configuration());
  Notified systemd;
  Process process =
      f.Start({"--fake"}, {{"NOTIFY_SOCKET", systemd.path()}, {"WATCHDOG_USEC", "400000"}});
  EXPECT_TRUE(systemd.Until("READY=1")) << process.err();
  EXPECT_TRUE(systemd.Until("WATCHDOG=1"));
  EXPECT_TRUE(systemd.Until("STATUS=tracking"));
  process.Signal(SIGHUP);
  EXPECT_TRUE(systemd.Until("RELOADING=1\nMONOTONIC_USEC="));
  process.Signal(SIGTERM);
  EXPECT_TRUE(systemd.Until("STOPPING=1"));
  EXPECT_EQ(process.Wait(), 0);
}

TEST(Facewired, ReadOnlyNeverMakesALine) {
  Facewired f(Configuration());
  Process process = f.Start({"--fake", "--read-only", "--seconds", "1"});
  EXPECT_EQ(process.Wait(), 0) << process.err();
  EXPECT_THAT(process.out(), HasSubstr(" 0 poses sent"));
}

TEST(Facewired, ChecksWithoutTouchingADevice) {
  Facewired f(
      "[camera]\ndevice = \"v4l2:/dev/no-such-camera\"\n[tracker]\n"
      "networks = \"" FACEWIRE_ASSETS "/networks\"\n[character]\nrig = \"" +
      std::string(kRig) + "\"\nprofile = \"" + kProfile +
      "\"\n[host]\nline = \"serial:/dev/no-such-port\"\n");
  Process check = f.Start({"--check", "--memory"});
  EXPECT_EQ(check.Wait(), 0) << check.err();
  EXPECT_THAT(check.out(), HasSubstr("ok\n"));
  EXPECT_THAT(check.out(), HasSubstr("otto: "));
  EXPECT_THAT(check.out(), HasSubstr("tracker "));
  EXPECT_THAT(check.out(), HasSubstr("total "));
  Process run = f.Start();
  EXPECT_EQ(run.Wait(), 2);
  EXPECT_THAT(run.err(), HasSubstr("/dev/no-such-port"));
}

// A profile of three poses of the given markers, which gives "jawOpen", and "mutter", always 1.
void WriteProfile(const Scratch& scratch, const std::vector<std::string>& markers) {
  TrainingSet training;
  retarget::RegionConfig region;
  region.name = *ShortName::From("face");
  region.rbf.smoothing = 0.01F;
  for (const std::string& marker : markers) {
    EXPECT_TRUE(region.points.try_push(static_cast<std::uint16_t>(training.markers.size())));
    training.markers.push_back(*ShortName::From(marker));
  }
  for (const char* signal : {"jawOpen", "mutter"}) {
    EXPECT_TRUE(region.outputs.try_push(static_cast<std::uint16_t>(training.signals.size())));
    training.signals.push_back(*ShortName::From(signal));
  }
  training.regions.push_back(region);
  for (const float open : {0.F, 0.5F, 1.F}) {
    for (std::size_t i = 0; i < markers.size(); ++i)
      training.samples.insert(training.samples.end(), {static_cast<float>(i), -open, 4});
    training.targets.insert(training.targets.end(), {open, 1});
  }
  SaveProfile(scratch / "me.profile", training);
}

std::string WithPersonalProfile() {
  return Replaced(Configuration("[control]\nsocket = \"control\"\n"), "[neutral]",
                  "personal = \"me.profile\"\nblend = 0.5\n[neutral]");
}

TEST(Facewired, CountsAPersonalProfileInCheckAndMemory) {
  Facewired f(WithPersonalProfile());
  WriteProfile(f.scratch, {"lm13", "lm14", "lm152", "lm61"});
  Process check = f.Start({"--fake", "--check", "--memory"});
  EXPECT_EQ(check.Wait(), 0) << check.err();
  EXPECT_THAT(check.out(), HasSubstr("me.profile: 2 signals, 1 of them shared, blend 0.50\n"));
  EXPECT_THAT(check.out(), HasSubstr("\npersonal profile "));
}

TEST(Facewired, BlendsASignalThatOnlyThePersonalProfileGivesByFileAndByCommand) {
  const auto configuration = [](const char* blend) {
    return Replaced(Replaced(WithPersonalProfile(), kRig, "rig.toml"), "blend = 0.5", blend);
  };
  Facewired f(configuration("blend = 0.5"));
  f.scratch.Write("rig.toml", "name = \"r\"\n[[parameter]]\nname = \"mutter\"\n");
  WriteProfile(f.scratch, {"lm13", "lm14", "lm152", "lm61"});
  Process process = f.Start({"--fake"});
  Listener host(f.scratch / "line");
  const auto mutters = [&](float value) {
    return host.state() == ServiceState::kTracking && host.rig.Complete() &&
           std::abs(wire::ValuesOf(host.poses.back(), host.rig.rig()).values[0] - value) < 1e-3F;
  };
  ASSERT_TRUE(host.Until([&] { return mutters(0.5F); })) << process.err();
  f.scratch.Write("facewire.toml", configuration("blend = 0.75"));
  process.Signal(SIGHUP);
  ASSERT_TRUE(host.Until([&] { return mutters(0.75F); })) << process.err();
  Process blend = Tool(f, {"blend", "25", (f.scratch / "control").string()});
  ASSERT_TRUE(host.Until([&] { return mutters(0.25F); })) << process.err();
  EXPECT_EQ(blend.Wait(), 0) << blend.err();
  process.Signal(SIGTERM);
  EXPECT_EQ(process.Wait(), 0);
}

struct Row {
  const char* name;
  std::function<void(Facewired&)> spoil;
  const char* complaint;
};

constexpr const char* kAttentionNetwork = "n/face_landmark_with_attention.tflite";

void CopyNetworks(const Facewired& f) {
  std::filesystem::copy(FACEWIRE_ASSETS "/networks", f.scratch / "n");
}

TEST(Facewired, RefusesBadInputWithOneLineAndExitCodeTwo) {
  const auto with = [](const std::string& text) {
    return [text](Facewired& f) { f.scratch.Write("facewire.toml", text); };
  };
  const auto networks = [](const std::string& folder) {
    return "[camera]\ndevice = \"replay\"\n[camera.replay]\nfile = \"x.mp4\"\n[tracker]\nnetworks "
           "= \"" +
           folder + "\"\n[character]\nrig = \"" + std::string(kRig) + "\"\nprofile = \"" +
           kProfile + "\"\n";
  };
  const std::string good = FACEWIRE_ASSETS "/networks";
  const std::vector<Row> table = {
      {"unknown key", with("[camera]\nwith = 3\n"), "unknown key \"camera.with\""},
      {"out of range", with("[states]\nhold_ms = -4\n"), "states.hold_ms: -4 is out of range"},
      {"no networks", with(networks("/nowhere")), "/nowhere"},
      {"missing network",
       [&](Facewired& f) {
         CopyNetworks(f);
         std::filesystem::remove(f.scratch / kAttentionNetwork);
         f.scratch.Write("facewire.toml", networks("n"));
       },
       "face_landmark_with_attention.tflite"},
      {"truncated network",
       [&](Facewired& f) {
         CopyNetworks(f);
         std::filesystem::resize_file(f.scratch / "n/face_detection_short_range.tflite", 1000);
         f.scratch.Write("facewire.toml", networks("n"));
       },
       "face_detection_short_range.tflite"},
      {"network with a wrong checksum",
       [&](Facewired& f) {
         CopyNetworks(f);
         std::string bytes = ReadAll(f.scratch / kAttentionNetwork);
         bytes[bytes.size() / 2] ^= 1;
         f.scratch.Write(kAttentionNetwork, bytes);
         f.scratch.Write("facewire.toml", networks("n"));
       },
       "SHA-256"},
      {"rig with a bone of an unknown landmark",
       [&](Facewired& f) {
         f.scratch.Write("rig.toml",
                         "name = \"r\"\n[[bone]]\nname = \"b\"\nlandmark = \"elbow\"\n");
         f.scratch.Write("facewire.toml", Configuration("", "rig.toml"));
       },
       "rig.toml:4:12: bone[0].landmark: no landmark \"elbow\""},
      {"profile that is none",
       [&](Facewired& f) {
         f.scratch.Write("p.profile", "not a profile, but long enough to look like a file of one");
         f.scratch.Write("facewire.toml", Configuration("", kRig, "p.profile"));
       },
       "p.profile"},
      {"profile of another version",
       [&](Facewired& f) {
         std::string bytes = ReadAll(kProfile);
         bytes[8] = 99;  // behind the magic: the version
         f.scratch.Write("p.profile", bytes);
         f.scratch.Write("facewire.toml", Configuration("", kRig, "p.profile"));
       },
       "p.profile: the profile is of version 99"},
      {"personal profile that is not there",
       [&](Facewired& f) { f.scratch.Write("facewire.toml", WithPersonalProfile()); },
       "me.profile: there is no such profile"},
      {"personal profile of a marker file's names",
       [&](Facewired& f) {
         WriteProfile(f.scratch, {"chin", "lip", "brow", "nose"});
         f.scratch.Write("facewire.toml", WithPersonalProfile());
       },
       "me.profile: reads markers (\"chin\", ...) that a camera does not show; train it with "
       "landmarks, lm0 to lm477"},
      {"video that is none",
       [&](Facewired& f) {
         f.scratch.Write("x.mp4", "not a video");
         f.scratch.Write("facewire.toml", networks(good) + "[host]\nline = \"none\"\n");
       },
       "x.mp4 is not a video"},
      {"no video", with(networks(good) + "[host]\nline = \"none\"\n"), "there is no video"},
      {"no port", with(networks(good) + "[host]\nline = \"serial:/dev/no-port\"\n"),
       "there is no port /dev/no-port"},
      {"no camera",
       with(Replaced(networks(good), "\"replay\"\n", "\"v4l2:/dev/no-camera\"\n") +
            "[host]\nline = \"none\"\n"),
       "/dev/no-camera: there is no such device"},
  };
  for (const Row& row : table) {
    Facewired f("");
    row.spoil(f);
    Process process = f.Start({"--stats-json", (f.scratch / "stats.json").string()});
    EXPECT_EQ(process.Wait(), 2) << row.name << ": " << process.err();
    const std::string err = process.err();
    EXPECT_THAT(err, HasSubstr(row.complaint)) << row.name;
    EXPECT_EQ(std::ranges::count(err, '\n'), 1) << row.name << ": " << err;
    EXPECT_EQ(process.out(), "") << row.name;
    EXPECT_FALSE(std::filesystem::exists(f.scratch / "stats.json")) << row.name;
    EXPECT_FALSE(std::filesystem::exists(f.scratch / "line")) << row.name;
    EXPECT_FALSE(std::filesystem::exists(f.scratch / "state")) << row.name;
  }
}

TEST(Facewired, ReportsWhatIsWrongWithEveryFileAtOnce) {
  Facewired f(Configuration("", "no-rig.toml", "no.profile"));
  Process process = f.Start({"--check"});
  EXPECT_EQ(process.Wait(), 2);
  EXPECT_THAT(process.err(), HasSubstr("no-rig.toml"));
  EXPECT_THAT(process.err(), HasSubstr("no.profile"));
}

TEST(Facewired, RefusesBadUsage) {
  Scratch scratch;
  for (const std::vector<std::string>& options : {std::vector<std::string>{},
                                                  {"--config"},
                                                  {"--nonsense"},
                                                  {"--config", "x", "--seconds", "-1"}}) {
    std::vector<std::string> command = {FACEWIRED};
    command.insert(command.end(), options.begin(), options.end());
    Process process(command, scratch / "out", scratch / "err");
    EXPECT_EQ(process.Wait(), 2);
    EXPECT_EQ(std::ranges::count(process.err(), '\n'), 1) << process.err();
  }
  Process version({FACEWIRED, "--version"}, scratch / "out", scratch / "err");
  EXPECT_EQ(version.Wait(), 0);
  EXPECT_THAT(version.out(), HasSubstr("facewired "));
}

}  // namespace
}  // namespace facewire::app
