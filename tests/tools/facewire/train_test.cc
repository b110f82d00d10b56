#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "app/profile_file.h"
#include "tests/app/scratch.h"
#include "tools/facewire/commands.h"

namespace facewire::tools {
namespace {

using app::BadInputOf;
using app::Scratch;
using testing::HasSubstr;

constexpr const char* kMarkers =
    "lip_x,lip_y,lip_z,lid_x,lid_y,lid_z\n"
    "0,0,0,3,3,0\n"
    "0,-1,0,3,3,0\n"
    "0,-2,0,3,3,0\n"
    "0,0,0,3,2,0\n"
    "0,-1,0,3,2,0\n";
constexpr const char* kTargets = "frame,jaw_deg,blink\n0,0,0\n1,10,0\n2,20,0\n3,0,1\n4,10,1\n";

// Files of one training, and a call of the command.
struct Context {
  Scratch scratch;
  std::string markers = kMarkers, targets = kTargets;
  std::string output;

  void Train(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"train",
                                          "--markers",
                                          scratch.Write("m.csv", markers).string(),
                                          "--targets",
                                          scratch.Write("t.csv", targets).string(),
                                          "--out",
                                          Out()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    std::ranges::reverse(arguments);
    CLI::App facewire;
    AddTrain(facewire);
    testing::internal::CaptureStdout();
    try {
      facewire.parse(arguments);
    } catch (...) {
      output = testing::internal::GetCapturedStdout();
      throw;
    }
    output = testing::internal::GetCapturedStdout();
  }
  std::string Out() const { return (scratch / "out.profile").string(); }
  std::string Error(std::vector<std::string> more = {}) {
    const std::string message = BadInputOf([&] { Train(std::move(more)); });
    EXPECT_FALSE(std::filesystem::exists(Out())) << "nothing half-written may be left";
    return message;
  }
  std::vector<float> At(std::vector<Point3> points) const {
    const auto profile = app::LoadProfile(Out());
    std::vector<float> signals(profile->mapping().signals().size());
    profile->mapping().Evaluate(points, signals);
    return signals;
  }
};

TEST(Train, MakesAProfileThatGivesTheTargetsBack) {
  Context c;
  c.Train();
  const auto signals = c.At({{0, -2, 0}, {3, 3, 0}});
  EXPECT_NEAR(signals[0], 20, 1e-2);
  EXPECT_NEAR(signals[1], 0, 1e-3);
  EXPECT_NEAR(c.At({{0, -1, 0}, {3, 2, 0}})[0], 10, 1e-2);
}

TEST(Train, PrintsTheLeaveOneOutErrorOfEachTarget) {
  Context c;
  c.Train();
  EXPECT_THAT(c.output, HasSubstr("leave-one-out"));
  EXPECT_THAT(c.output, HasSubstr("\njaw_deg "));
  EXPECT_THAT(c.output, HasSubstr("\nblink "));
  EXPECT_THAT(c.output, testing::Not(HasSubstr("frame ")));
}

TEST(Train, KeepsTheChosenSettings) {
  Context c;
  c.Train({"--kernel", "gaussian", "--epsilon", "0.7", "--smoothing", "0.1", "--tail", "constant",
           "--neutral", "3", "--average-user", "--axes", "2"});
  const app::TrainingSet training = app::ReadTrainingSet(c.Out());
  ASSERT_EQ(training.regions.size(), 1U);
  EXPECT_EQ(training.regions[0].rbf.kernel, rbf::Kernel::kGaussian);
  EXPECT_EQ(training.regions[0].rbf.tail, rbf::Tail::kConstant);
  EXPECT_EQ(training.regions[0].rbf.epsilon, 0.7F);
  EXPECT_EQ(training.regions[0].rbf.smoothing, 0.1F);
  EXPECT_EQ(training.regions[0].axes, 2);
  EXPECT_EQ(training.neutral_sample, 2U);
  EXPECT_TRUE(training.average_user);
}

TEST(Train, WritesTheAutomaticEpsilonDownSoThatLoadingIsQuick) {
  Context c;
  c.Train();
  EXPECT_GT(app::ReadTrainingSet(c.Out()).regions[0].rbf.epsilon, 0);
}

TEST(Train, MeetsEveryRowWhenNoRowIsKnownFromTheOthers) {
  Context c;
  c.markers = "lip_x,lip_y,lip_z,lid_x,lid_y,lid_z\n0,0,0,3,3,0\n0,-2,0,3,3,0\n0,0,0,3,2,0\n";
  c.targets = "jaw,blink\n0,0\n1,0\n0,1\n";
  c.Train();
  EXPECT_THAT(c.output, HasSubstr("smoothing 0, "));
  EXPECT_THAT(c.output, HasSubstr("chosen to meet every row"));
  // Both at once, which no row shows: motion adds up.
  const auto both = c.At({{0, -2, 0}, {3, 2, 0}});
  EXPECT_NEAR(both[0], 1, 0.05F);
  EXPECT_NEAR(both[1], 1, 0.05F);
}

TEST(Train, SmoothsAsMuchAsTheOtherRowsSay) {
  Context c;
  c.markers = "lip_x,lip_y,lip_z\n";
  c.targets = "jaw\n";
  for (int row = 0; row < 40; ++row) {
    // A straight line in half a millimetre of noise.
    const double open = row % 20 * 0.1;
    c.markers += "0," + std::to_string(-open + 0.05 * std::sin(91.0 * row)) + ",0\n";
    c.targets += std::to_string(open) + "\n";
  }
  c.Train();
  EXPECT_THAT(c.output, HasSubstr("chosen for the least leave-one-out error"));
  EXPECT_GT(app::ReadTrainingSet(c.Out()).regions[0].rbf.smoothing, 0);
}

TEST(Train, NonNegativeLeastSquaresAreAMethodToo) {
  Context c;
  c.Train({"--method", "nnls"});
  EXPECT_EQ(app::ReadTrainingSet(c.Out()).regions[0].method, retarget::Method::kNnls);
  EXPECT_THAT(c.output, HasSubstr("non-negative least squares"));
  EXPECT_NEAR(c.At({{0, -1, 0}, {3, 2, 0}})[0], 10, 1e-2);
  EXPECT_EQ(c.At({{0, 5, 0}, {3, 4, 0}})[0], 0) << "never below what was trained";
}

TEST(Train, TheMethodIsTheRegionsOwn) {
  Context c;
  const auto regions = c.scratch.Write("r.toml",
                                       "[[region]]\nname = \"mouth\"\npoints = [\"lip\"]\n"
                                       "targets = [\"jaw_deg\"]\nmethod = \"nnls\"\n"
                                       "[[region]]\nname = \"eye\"\npoints = [\"lid\"]\n"
                                       "targets = [\"blink\"]\nsmoothing = 0.01\n");
  c.Train({"--regions", regions.string(), "--axes", "2"});
  const auto trained = app::ReadTrainingSet(c.Out()).regions;
  EXPECT_EQ(trained[0].method, retarget::Method::kNnls);
  EXPECT_EQ(trained[0].axes, 2);
  EXPECT_EQ(trained[1].method, retarget::Method::kRbf);
  EXPECT_EQ(trained[1].rbf.smoothing, 0.01F);
  EXPECT_NEAR(c.At({{0, -1, 0}, {3, 3, 0}})[0], 10, 1e-2);
}

TEST(Train, ARegionThatIgnoresOthersFindsItsSettingsToo) {
  Context c;
  const auto regions = c.scratch.Write(
      "r.toml",
      "[[region]]\nname = \"mouth\"\npoints = [\"lip\"]\ntargets = [\"jaw_deg\"]\n"
      "[[region]]\nname = \"eye\"\npoints = [\"lid\", \"lip\"]\ntargets = [\"blink\"]\n"
      "axes = 2\nsmoothing = 0.01\nignores = [\"jaw_deg\"]\n");
  c.Train({"--regions", regions.string()});
  EXPECT_EQ(app::ReadTrainingSet(c.Out()).regions[1].ignores.size(), 1U);
  EXPECT_NEAR(c.At({{0, -1, 0}, {3, 2, 0}})[1], c.At({{0, 0, 0}, {3, 2, 0}})[1], 1e-3);
}

TEST(Train, TakesTheMeanDistanceFromTheCommandLineAndFromARegion) {
  Context c;
  c.Train({"--epsilon", "mean"});
  const float mean = app::ReadTrainingSet(c.Out()).regions[0].rbf.epsilon;
  EXPECT_GT(mean, 0);
  const auto regions = c.scratch.Write("r.toml",
                                       "[[region]]\nname = \"face\"\n"
                                       "points = [\"lip\", \"lid\"]\n"
                                       "targets = [\"jaw_deg\", \"blink\"]\nepsilon = \"mean\"\n"
                                       "kernel = \"thin-plate\"\ntail = \"constant\"\n");
  c.Train({"--regions", regions.string(), "--epsilon", "0.5"});
  const app::TrainingSet read = app::ReadTrainingSet(c.Out());
  EXPECT_NEAR(read.regions[0].rbf.epsilon, mean, 1e-6);
  EXPECT_EQ(read.regions[0].rbf.kernel, rbf::Kernel::kThinPlate);
}

TEST(Train, AWeightHoldsARowThatSmoothingWouldMove) {
  Context c;
  const auto blink_at_rest = [&] { return c.At({{0, 0, 0}, {3, 3, 0}})[1]; };
  std::vector<std::string> settings = {"--smoothing", "2",         "--tail-smoothing",
                                       "50",          "--epsilon", "1"};
  c.Train(settings);
  EXPECT_GT(blink_at_rest(), 0.05F);
  const std::string weights = c.scratch.Write("w.csv", "weight\n1000\n1\n1\n1\n1\n").string();
  settings.insert(settings.end(), {"--weights", weights});
  c.Train(settings);
  EXPECT_NEAR(blink_at_rest(), 0, 1e-2);
}

TEST(Train, WeightsThatDoNotFitAreRefused) {
  const auto with = [](const char* weights) {
    Context c;
    return c.Error({"--weights", c.scratch.Write("w.csv", weights).string()});
  };
  EXPECT_THAT(with("weight\n1\n1\n"), HasSubstr("w.csv: 2 rows, but"));
  EXPECT_THAT(with("heft\n1\n1\n1\n1\n1\n"), HasSubstr("w.csv:1: expected one column, weight"));
  EXPECT_THAT(with("weight\n1\n1\n0\n1\n1\n"),
              HasSubstr("row 3: a weight has to be a number above 0"));
}

TEST(Train, RegionsKeepTheirMarkersApart) {
  Context c;
  const auto regions = c.scratch.Write("r.toml",
                                       "[[region]]\nname = \"mouth\"\npoints = [\"lip\"]\n"
                                       "targets = [\"jaw_deg\"]\nsmoothing = 0.01\n"
                                       "[[region]]\nname = \"eye\"\n"
                                       "gaps = [[\"lip\", \"lid\"]]\npoints = [\"lid\"]\n"
                                       "targets = [\"blink\"]\nsmoothing = 0.01\naxes = 2\n");
  c.Train({"--regions", regions.string(), "--epsilon", "0.5", "--tail", "constant"});
  EXPECT_EQ(c.At({{0, -1, 0}, {3, 3, 0}})[0], c.At({{0, -1, 0}, {9, 9, 9}})[0]);
}

// A recorded face has more landmarks than a profile holds.
TEST(Train, LeavesOutTheMarkersThatNoRegionReads) {
  Context c;
  c.markers = "lm0_x,lm0_y,lm0_z";
  for (int i = 1; i < 478; ++i) {
    const std::string name = ",lm" + std::to_string(i);
    c.markers.append(name + "_x").append(name + "_y").append(name + "_z");
  }
  for (int row = 0; row < 5; ++row) {
    c.markers += "\n0,0,0";
    for (int i = 1; i < 478; ++i)
      c.markers += i == 13 ? ",0," + std::to_string(-row) + ",0" : i == 374 ? ",3,2,0" : ",9,9,9";
  }
  c.targets = "open\n0\n0.25\n0.5\n0.75\n1\n";
  EXPECT_THAT(c.Error(), HasSubstr("at most 128 markers"));
  const auto regions = c.scratch.Write("r.toml",
                                       "[[region]]\nname = \"lips\"\npoints = [\"lm374\"]\n"
                                       "gaps = [[\"lm374\", \"lm13\"]]\ntargets = [\"open\"]\n");
  c.Train({"--regions", regions.string()});
  const app::TrainingSet training = app::ReadTrainingSet(c.Out());
  ASSERT_EQ(training.markers.size(), 2U);
  EXPECT_EQ(training.markers[0].view(), "lm13");
  EXPECT_EQ(training.markers[1].view(), "lm374");
  EXPECT_NEAR(c.At({{0, -4, 0}, {3, 2, 0}})[0], 1, 1e-2);
}

TEST(Train, BadInputIsOneLineAndLeavesNothing) {
  const auto with = [](const char* markers, const char* targets,
                       std::vector<std::string> more = {}) {
    Context c;
    if (markers != nullptr) c.markers = markers;
    if (targets != nullptr) c.targets = targets;
    return c.Error(std::move(more));
  };
  EXPECT_THAT(with("a_x,a_y,a_z\n0,0,0\n1,0\n", nullptr),
              HasSubstr("m.csv:3: 2 fields; the header has 3"));
  EXPECT_THAT(with(nullptr, "a\n1\n2\n3\n4\noops\n"),
              HasSubstr("t.csv:6: column a: \"oops\" is not a number"));
  EXPECT_THAT(with(nullptr, "a\n1\n2\n"), HasSubstr("t.csv: 2 rows, but "));
  EXPECT_THAT(with("", nullptr), HasSubstr("no columns"));
  EXPECT_THAT(with("a_x,a_y,a_z\n", nullptr), HasSubstr("m.csv: no rows"));
  EXPECT_THAT(with("a_x,a_y,a_z\n0,0,0\n1,,0\n", nullptr),
              HasSubstr("m.csv:3: the marker a was not seen here"));
  EXPECT_THAT(with("note,a_x,a_y,a_z\n0,0,0,0\n", nullptr),
              HasSubstr("column note does not start"));
  EXPECT_THAT(with(nullptr, "frame,a,b\n0,0,0\n1,2,\n"),
              HasSubstr("t.csv:3: column b is empty; every sample needs its value"));
  EXPECT_THAT(with(nullptr, "frame,t_us\n0,0\n"), HasSubstr("no columns besides"));
  EXPECT_THAT(with(nullptr, "a\n"), HasSubstr("t.csv: no rows"));
  EXPECT_THAT(with(nullptr, "open,open\n1,2\n"), HasSubstr("\"open\" appears twice"));
  EXPECT_THAT(with(nullptr, "jaw open\n1\n"), HasSubstr("\"jaw open\" cannot be a name"));
  EXPECT_THAT(with(nullptr, "a,,b\n1,2,3\n"), HasSubstr("\"\" cannot be a name"));
  EXPECT_THAT(with("a_x,a_y,a_z\n0,0,0\n1,0,0\n2,0,0\n1,0,0\n5,0,0\n", nullptr),
              HasSubstr("rows 2 and 4 have the same markers"));
  EXPECT_THAT(with(nullptr, nullptr, {"--kernel", "sinc"}), HasSubstr("one of multiquadric"));
  EXPECT_THAT(with(nullptr, nullptr, {"--tail", "cubic"}), HasSubstr("one of none, constant"));
  EXPECT_THAT(with(nullptr, nullptr, {"--epsilon", "-1"}), HasSubstr("neither auto nor mean nor"));
  EXPECT_THAT(with(nullptr, nullptr, {"--smoothing", "-1"}), HasSubstr("--smoothing: "));
  EXPECT_THAT(with(nullptr, nullptr, {"--neutral", "6"}), HasSubstr("rows 1 to 5"));
  EXPECT_THAT(with(nullptr, nullptr, {"--tail-smoothing", "0"}), HasSubstr("linear tail"));
  EXPECT_THAT(with(nullptr, nullptr, {"--tail-smoothing", "much"}),
              HasSubstr("--tail-smoothing: \"much\" is neither auto nor a number from 0 up"));
  EXPECT_THAT(with(nullptr, nullptr, {"--method", "magic"}), HasSubstr("one of rbf, nnls"));
  EXPECT_THAT(with(nullptr, nullptr, {"--axes", "7"}), HasSubstr("more than the 6 coordinates"));
  EXPECT_THAT(
      with(nullptr, "a,b\n0,0\n1,1\n2,2\n0,0\n1,1\n", {"--method", "nnls", "--smoothing", "0"}),
      HasSubstr("what target \"b\" moves"));
  EXPECT_THAT(with("a_x,a_y,a_z\n0,0,0\n1,0,0\n2,0,0\n1,0,0\n5,0,0\n", nullptr,
                   {"--method", "nnls", "--smoothing", "0"}),
              HasSubstr("rows 2 and 4 have the same markers and other targets"));
  EXPECT_THAT(with(nullptr, nullptr, {"--regions", "none.toml"}), HasSubstr("none.toml"));
}

TEST(Train, ABadRegionFileIsNamedWithItsLine) {
  const auto with = [](const std::string& regions) {
    Context c;
    return c.Error({"--regions", c.scratch.Write("r.toml", regions).string()});
  };
  const std::string eye = "[[region]]\nname = \"eye\"\npoints = [\"lid\"]\ntargets = [\"blink\"]\n";
  EXPECT_THAT(with("region = "), HasSubstr("r.toml:1: "));
  EXPECT_THAT(with(""), HasSubstr("no regions"));
  EXPECT_THAT(with("other = 1\n"), HasSubstr("r.toml:1: unknown key \"other\""));
  EXPECT_THAT(with(eye + "colour = 1\n"), HasSubstr("r.toml:5: unknown key \"colour\""));
  EXPECT_THAT(with(eye), HasSubstr("target \"jaw_deg\" is in 0 regions"));
  EXPECT_THAT(with(eye + eye), HasSubstr("is in "));
  EXPECT_THAT(with(eye + "origin = [\"nose\"]\n"),
              HasSubstr("r.toml:5: there is no marker \"nose\""));
  EXPECT_THAT(with(eye + "smoothing = -1\n"), HasSubstr("r.toml:5: smoothing"));
  EXPECT_THAT(with(eye + "method = \"magic\"\n"), HasSubstr("r.toml:5: \"magic\""));
  EXPECT_THAT(with(eye + "smoothing = \"some\"\n"), HasSubstr("r.toml:5: smoothing"));
  EXPECT_THAT(with(eye + "axes = 4\n"), HasSubstr("r.toml:5: axes"));
  EXPECT_THAT(with(eye + "kernel = \"sinc\"\n"), HasSubstr("r.toml:5: \"sinc\""));
  EXPECT_THAT(with(eye + "dead_zone = 0.3\n"), HasSubstr("r.toml:5: dead_zone"));
  EXPECT_THAT(with(eye + "ignores = [\"nose\"]\n"), HasSubstr("there is no target \"nose\""));
  EXPECT_THAT(with(eye + "ignores = [\"jaw_deg\"]\n"), HasSubstr("r.toml:5: ignores needs axes"));
  EXPECT_THAT(with("[[region]]\nname = \"x\"\ntargets = [\"blink\"]\n"), HasSubstr("needs points"));
}

TEST(Train, AnOldProfileStaysWhenTrainingFails) {
  Context c;
  c.Train();
  const std::string before = Scratch::Read(c.Out());
  c.targets = "a\n1\n";
  EXPECT_THAT(BadInputOf([&] { c.Train(); }), HasSubstr("1 rows"));
  EXPECT_EQ(Scratch::Read(c.Out()), before);
}

}  // namespace
}  // namespace facewire::tools
