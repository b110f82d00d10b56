#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/error.h"
#include "core/wire/encoder.h"
#include "core/wire/pose.h"
#include "core/wire/rig_description.h"
#include "hal/fake/fake_clock.h"
#include "hal/fake/fake_serial_port.h"
#include "tests/core/wire/test_rig.h"
#include "tools/facewire/monitor_session.h"
#include "tools/facewire/stream_port.h"

namespace facewire::tools {
namespace {

using std::chrono::milliseconds;
using Bytes = std::vector<std::byte>;

// A device at the far end of a fake line, and a session that listens to it.
struct Context {
  hal::fake::FakeClock clock{Time(Duration(1'000'000))};
  hal::fake::FakeSerialPort port{clock};
  Rig rig = wire::TestRig();
  wire::Encoder encoder;
  std::string shown;
  MonitorDisplay display{.kind = MonitorDisplay::Kind::kNone,
                         .style = {.unicode = false, .colour = false},
                         .size =
                             [] {
                               return ScreenSize{80, 24};
                             },
                         .write = [this](std::string_view text) { shown += text; }};
  MonitorLimits limits{.seconds = 3.0, .frames = std::nullopt, .may_write = true};
  std::unique_ptr<MonitorSession> session;

  Context() { EXPECT_TRUE(port.Open()); }

  Bytes Frame(const wire::Message& message) {
    std::array<std::byte, wire::kMaxFrameBytes> buffer;
    const auto frame = encoder.Encode(message, buffer).value();
    return {frame.begin(), frame.end()};
  }
  Bytes PoseFrame(std::uint64_t seq, Time at) {
    RigPose pose = rig.NeutralPose();
    pose.seq = seq;
    pose.captured = at;
    pose.values[0] = 22;
    pose.values[3] = 0.5F;
    return Frame(wire::MakePose(rig, wire::RigId(rig), pose, ServiceState::kTracking,
                                at + milliseconds(31)));
  }
  void Feed(const Bytes& bytes, Time at = Time{}) { ASSERT_TRUE(port.Feed(bytes, at)); }
  void FeedDescription() {
    for (std::size_t i = 0; i < wire::DescriptionCount(rig); ++i) {
      Feed(Frame(*wire::Description(rig, wire::RigId(rig), i)));
    }
  }
  // `count` poses, 1/25 s apart.
  void FeedPoses(std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      const Time at = clock.Now() + milliseconds(40 * (i + 1));
      Feed(PoseFrame(100 + i, at), at);
    }
  }
  MonitorEnd Run(MonitorRecorder* recorder = nullptr) {
    session = std::make_unique<MonitorSession>("fake", port, clock, display, recorder);
    return session->Run(limits, [] { return false; });
  }
  // The commands that the session wrote.
  std::vector<wire::Command> Asked() {
    const auto& written = port.written();
    wire::Decoder decoder;
    std::vector<wire::Command> commands;
    for (std::size_t i = 0; i < written.size(); ++i) {
      std::span<const std::byte> one(&written[i], 1);
      if (const auto received = decoder.Next(one)) {
        commands.push_back(std::get<wire::Command>(received->message));
      }
    }
    return commands;
  }
};

class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "monitor_test.XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string File(const char* name) const { return (path_ / name).string(); }
  std::size_t Count() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }

 private:
  std::filesystem::path path_;
};

std::string Contents(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::string line;
  for (char c : text) {
    if (c == '\n') {
      lines.push_back(std::exchange(line, {}));
    } else {
      line += c;
    }
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

int CharactersIn(std::string_view text) {
  return static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

TEST(MonitorSession, AsksForTheRigUntilItIsKnownAndThenNoMore) {
  Context context;
  context.FeedPoses(2);
  context.limits.seconds = 2.5;
  EXPECT_EQ(context.Run(), MonitorEnd::kTime);
  const auto asked = context.Asked();
  ASSERT_EQ(asked.size(), 3U);
  EXPECT_EQ(asked[0].code, wire::CommandCode::kDescribeRig);
  EXPECT_NE(asked[0].id, asked[1].id);

  Context described;
  described.FeedDescription();
  described.FeedPoses(2);
  EXPECT_EQ(described.Run(), MonitorEnd::kTime);
  EXPECT_EQ(described.Asked().size(), 1U);
}

TEST(MonitorSession, AsksAgainWhenThePosesAreOfAnotherRig) {
  Context context;
  context.FeedDescription();
  context.rig.channels[0].max = 30;
  context.FeedPoses(3);
  EXPECT_EQ(context.Run(), MonitorEnd::kTime);
  EXPECT_FALSE(context.session->model().RigKnown());
  EXPECT_GE(context.Asked().size(), 2U);
}

TEST(MonitorSession, NeverWritesWhenItMayNot) {
  Context context;
  context.limits.may_write = false;
  EXPECT_EQ(context.Run(), MonitorEnd::kTime);
  EXPECT_TRUE(context.Asked().empty());
}

TEST(MonitorSession, ALineThatTakesNothingIsStillRead) {
  Context context;
  context.port.AcceptOnly(0);
  context.FeedPoses(5);
  EXPECT_EQ(context.Run(), MonitorEnd::kTime);
  EXPECT_EQ(context.session->model().poses, 5U);
}

TEST(MonitorSession, EndsAfterSoManyPosesExactly) {
  Context context;
  context.FeedPoses(20);
  context.limits.frames = 7;
  EXPECT_EQ(context.Run(), MonitorEnd::kFrames);
  EXPECT_EQ(context.session->model().poses, 7U);
}

TEST(MonitorSession, EndsWhenTheLineClosesAndWhenAskedTo) {
  Context context;
  context.port.Unplug();
  EXPECT_EQ(context.Run(), MonitorEnd::kClosed);
  context.session = std::make_unique<MonitorSession>("fake", context.port, context.clock,
                                                     context.display, nullptr);
  EXPECT_EQ(context.session->Run(context.limits, [] { return true; }), MonitorEnd::kInterrupted);
}

TEST(MonitorSession, MeasuresRateAndLatencyAndCountsDamage) {
  Context context;
  context.FeedDescription();
  context.FeedPoses(10);
  const Time late = context.clock.Now() + milliseconds(1000);
  Bytes damaged = context.PoseFrame(200, late);
  damaged[damaged.size() / 2] ^= std::byte{0x55};
  context.Feed(damaged, late);
  context.Feed(context.PoseFrame(201, context.clock.Now() + milliseconds(440)), late);
  EXPECT_EQ(context.Run(), MonitorEnd::kTime);
  const MonitorModel& m = context.session->model();
  EXPECT_NEAR(m.rate.fps().value(), 25, 0.01);
  EXPECT_EQ(m.ages.Quantile(0.5), 31);
  EXPECT_EQ(m.link.Damaged(), 1U);
  EXPECT_EQ(m.link.lost, 1U);
  EXPECT_EQ(m.link.resyncs, 1U);
  EXPECT_EQ(m.state, ServiceState::kTracking);
  EXPECT_NE(SummaryText(m).find("1 lost"), std::string::npos);
}

TEST(MonitorSession, APlainDisplayHasOneLineASecond) {
  Context context;
  context.display.kind = MonitorDisplay::Kind::kPlain;
  context.FeedDescription();
  context.FeedPoses(20);
  context.limits.seconds = 3.5;
  EXPECT_EQ(context.Run(), MonitorEnd::kTime);
  const auto lines = Lines(context.shown);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_NE(lines[0].find("tracking"), std::string::npos) << lines[0];
  EXPECT_NE(lines[0].find("25.0 fps"), std::string::npos) << lines[0];
  EXPECT_EQ(context.shown.find('\x1b'), std::string::npos);
}

TEST(MonitorSession, AScreenIsDrawnOverItselfWithoutBeingCleared) {
  Context context;
  context.display.kind = MonitorDisplay::Kind::kScreen;
  context.FeedDescription();
  context.FeedPoses(5);
  EXPECT_EQ(context.Run(), MonitorEnd::kTime);
  EXPECT_TRUE(context.shown.starts_with("\x1b[H"));
  EXPECT_EQ(context.shown.find("\x1b[2J"), std::string::npos);
  EXPECT_NE(context.shown.find("jawOpen"), std::string::npos);
}

TEST(MonitorSession, ADevicesRefusalIsShown) {
  Context context;
  context.display.kind = MonitorDisplay::Kind::kScreen;
  context.Feed(context.Frame(wire::Acknowledgement{
      .id = 1, .code = wire::CommandCode::kDescribeRig, .result = wire::CommandResult::kUnknown}));
  EXPECT_EQ(context.Run(), MonitorEnd::kTime);
  EXPECT_NE(context.shown.find("describe_rig: unknown_command"), std::string::npos);
}

TEST(MonitorRecorder, WritesEveryPoseAsCsvAlsoThoseBeforeTheDescription) {
  const Folder folder;
  Context context;
  MonitorRecorder recorder(folder.File("out.csv"), MonitorRecorder::Form::kCsv);
  context.Feed(context.PoseFrame(5, Time(Duration(2'000'000))));
  context.FeedDescription();
  context.Feed(context.PoseFrame(6, Time(Duration(2'040'000))));
  EXPECT_EQ(context.Run(&recorder), MonitorEnd::kTime);
  recorder.Finish(context.session->model().rig);
  EXPECT_EQ(recorder.recorded(), 2U);
  const auto lines = Lines(Contents(folder.File("out.csv")));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0], "frame,t_us,age_us,state,jaw.pitch,head.yaw,jaw.y,jawOpen");
  EXPECT_TRUE(lines[1].starts_with("5,2000000,31000,tracking,22,")) << lines[1];
  EXPECT_TRUE(lines[2].starts_with("6,2040000,31000,tracking,22,")) << lines[2];
}

TEST(MonitorRecorder, WritesAJsonObjectALine) {
  const Folder folder;
  Context context;
  MonitorRecorder recorder(folder.File("out.jsonl"), MonitorRecorder::Form::kJsonl);
  context.FeedDescription();
  context.Feed(context.PoseFrame(6, Time(Duration(7))));
  EXPECT_EQ(context.Run(&recorder), MonitorEnd::kTime);
  recorder.Finish(context.session->model().rig);
  EXPECT_EQ(Contents(folder.File("out.jsonl")),
            "{\"frame\":6,\"t_us\":7,\"age_us\":31000,\"state\":\"tracking\",\"values\":"
            "{\"jaw.pitch\":22,\"head.yaw\":0.000687,\"jaw.y\":0.000008,\"jawOpen\":0.500008}}\n");
}

TEST(MonitorRecorder, LeavesNothingBehindWhenTheRigNeverCame) {
  const Folder folder;
  {
    Context context;
    MonitorRecorder recorder(folder.File("out.csv"), MonitorRecorder::Form::kCsv);
    context.FeedPoses(3);
    EXPECT_EQ(context.Run(&recorder), MonitorEnd::kTime);
    EXPECT_THROW(recorder.Finish(context.session->model().rig), app::Failure);
  }
  EXPECT_EQ(folder.Count(), 0U);
}

TEST(MonitorRecorder, PosesOfAnotherRigAreCountedAndNotMixedIn) {
  const Folder folder;
  Context context;
  MonitorRecorder recorder(folder.File("out.csv"), MonitorRecorder::Form::kCsv);
  context.FeedDescription();
  context.FeedPoses(2);
  context.rig.channels[0].max = 30;
  context.Feed(context.PoseFrame(300, Time(Duration(9))), context.clock.Now() + milliseconds(500));
  EXPECT_EQ(context.Run(&recorder), MonitorEnd::kTime);
  EXPECT_EQ(recorder.recorded(), 2U);
  EXPECT_EQ(recorder.of_other_rigs(), 1U);
}

MonitorModel ModelOf(std::size_t channels, bool described = true) {
  Rig rig;
  rig.name = *ShortName::From("wide");
  for (std::size_t i = 0; i < channels; ++i) {
    Channel c;
    c.name = *ShortName::From("aChannelWithQuiteALong" + std::to_string(i));
    c.kind = i % 2 == 0 ? ChannelKind::kParameter : ChannelKind::kYaw;
    (void)rig.channels.try_push(c);
  }
  MonitorModel model;
  model.port = "/dev/serial/by-id/a-port-with-a-very-long-name-indeed-as-they-have";
  model.pose =
      wire::MakePose(rig, wire::RigId(rig), rig.NeutralPose(), ServiceState::kHolding, Time{});
  model.state = ServiceState::kHolding;
  for (std::size_t i = 0; described && i < wire::DescriptionCount(rig); ++i) {
    (void)model.rig.Add(*wire::Description(rig, wire::RigId(rig), i));
  }
  return model;
}

TEST(MonitorView, FillsExactlyTheTerminalWhateverItsSize) {
  for (std::size_t channels : {0U, 1U, 31U, 192U}) {
    const MonitorModel model = ModelOf(channels);
    for (int columns : {1, 20, 40, 79, 80, 120, 250}) {
      for (int rows : {1, 5, 6, 7, 24, 60}) {
        for (bool unicode : {true, false}) {
          const auto text =
              DrawScreen(model, {columns, rows}, {.unicode = unicode, .colour = false});
          EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), rows - 1) << columns << "x" << rows;
          for (const std::string& line : Lines(text))
            EXPECT_LE(CharactersIn(line), columns) << line;
        }
      }
    }
  }
}

TEST(MonitorView, ChannelsThatFitNowhereAreCounted) {
  const auto text = DrawScreen(ModelOf(192), {80, 24}, {.unicode = false, .colour = false});
  EXPECT_NE(text.find("156 more channels"), std::string::npos) << text;
}

TEST(MonitorView, AsciiMeansAsciiAndNoColourMeansNoEscapes) {
  const auto text = DrawScreen(ModelOf(31), {80, 24}, {.unicode = false, .colour = false});
  EXPECT_TRUE(std::all_of(text.begin(), text.end(),
                          [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
}

TEST(MonitorView, ARigThatIsNotKnownYetShowsNumberedChannels) {
  const auto text = DrawScreen(ModelOf(3, false), {80, 24}, {.unicode = false, .colour = false});
  EXPECT_NE(text.find("waiting for the rig description"), std::string::npos);
  EXPECT_NE(text.find("channel2"), std::string::npos);
}

TEST(MonitorView, BarsGrowFromNeutralToTheValue) {
  EXPECT_EQ(DrawBar(0, 0, 0, 1, 4, false), "|...");
  EXPECT_EQ(DrawBar(1, 0, 0, 1, 4, false), "####");
  EXPECT_EQ(DrawBar(0.5, 0, 0, 1, 4, false), "##..");
  EXPECT_EQ(DrawBar(0, 0, -1, 1, 4, false), "..|.");
  EXPECT_EQ(DrawBar(-1, 0, -1, 1, 4, false), "##|.");
  EXPECT_EQ(DrawBar(1, 0, -1, 1, 4, false), "..##");
  EXPECT_EQ(DrawBar(0.625, 0, 0, 1, 4, true), "██▌·");
  EXPECT_EQ(DrawBar(-0.25, 0, -1, 1, 4, true), "·▐│·");
}

TEST(MonitorView, BarsStayInTheirBoundsForAnyNumber) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(DrawBar(kNan, 0, -1, 1, 4, false), "..|.");
  EXPECT_EQ(DrawBar(1e30, 0, -1, 1, 4, false), "..##");
  EXPECT_EQ(DrawBar(-HUGE_VAL, 0, -1, 1, 4, false), "##|.");
  EXPECT_EQ(DrawBar(4, 4, 4, 4, 4, false), "|...");
}

TEST(MonitorView, ValuesHaveTheirUnitAndNoNegativeZero) {
  Channel c;
  EXPECT_EQ(ValueText(c, -0.0001F, true), "0.00");
  c.kind = ChannelKind::kPitch;
  EXPECT_EQ(ValueText(c, -12.5F, true), "-12.5°");
  EXPECT_EQ(ValueText(c, -12.5F, false), "-12.5 deg");
  c.kind = ChannelKind::kPositionY;
  EXPECT_EQ(ValueText(c, 0.25F, true), "0.25 cm");
}

TEST(CaptureRate, IgnoresRepeatsAndStartsOverWhenTimeDoes) {
  CaptureRate rate;
  EXPECT_FALSE(rate.fps());
  for (int i = 0; i < 100; ++i) {
    rate.Add(Time(Duration(i / 2 * 20'000)));
  }
  EXPECT_NEAR(rate.fps().value(), 50, 1e-9);
  rate.Add(Time(Duration(0)));
  EXPECT_FALSE(rate.fps());
}

TEST(StreamPort, ReadsAFileToItsEndAndCannotBeWritten) {
  const Folder folder;
  std::ofstream(folder.File("line.bin"), std::ios::binary) << "abc";
  StreamPort port(folder.File("line.bin"));
  std::array<std::byte, 16> buffer;
  EXPECT_EQ(port.Read(buffer, milliseconds(0)).error(), Errc::kDisconnected);
  ASSERT_TRUE(port.Open());
  EXPECT_EQ(port.Read(buffer, milliseconds(0)).value(), 3U);
  EXPECT_EQ(port.Read(buffer, milliseconds(0)).error(), Errc::kEnd);
  EXPECT_EQ(port.Write(buffer, milliseconds(0)).error(), Errc::kUnsupported);
  EXPECT_EQ(StreamPort(folder.File("none")).Open().error(), Errc::kNotFound);
}

TEST(StreamPort, AFifoIsSilentUntilItsWriterComesAndEndsWhenItLeaves) {
  const Folder folder;
  ASSERT_EQ(mkfifo(folder.File("fifo").c_str(), 0600), 0);
  StreamPort port(folder.File("fifo"));
  std::array<std::byte, 16> buffer;
  ASSERT_TRUE(port.Open());
  EXPECT_EQ(port.Read(buffer, milliseconds(1)).error(), Errc::kTimeout);
  const int writer = open(folder.File("fifo").c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_GE(writer, 0);
  ASSERT_EQ(write(writer, "ab", 2), 2);
  EXPECT_EQ(port.Read(buffer, milliseconds(1000)).value(), 2U);
  EXPECT_EQ(port.Read(buffer, milliseconds(1)).error(), Errc::kTimeout);
  close(writer);
  EXPECT_EQ(port.Read(buffer, milliseconds(1000)).error(), Errc::kEnd);
}

}  // namespace
}  // namespace facewire::tools
