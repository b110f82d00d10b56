#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "tests/app/scratch.h"
#include "tests/support/generated_take.h"

// The example of tools/examples/animface as a person runs it, on a take whose truth is known.
namespace facewire {
namespace {

using app::Scratch;
using testing::HasSubstr;

struct Context {
  Scratch scratch;
  test::GeneratedTake take = test::GenerateTake();
  std::string output;

  // The exit code of the example.
  int Run(const std::string& values) {
    const auto quoted = [&](const char* name) { return " '" + (scratch / name).string() + "'"; };
    scratch.Write("take.csv", take.markers_csv);
    scratch.Write("values.csv", values);
    const std::string command =
        "FACEWIRE='" FACEWIRE_TOOL "' '" FACEWIRE_SOURCE_DIR "/tools/examples/animface/run'" +
        quoted("take.csv") + quoted("out") + quoted("values.csv") + " >" + quoted("log") + " 2>&1";
    const int status = std::system(command.c_str());
    output = Scratch::Read(scratch / "log");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

// A column of a CSV without gaps.
std::vector<double> Column(const std::string& csv, const std::string& name) {
  const std::vector<std::string> lines = Split(csv, '\n');
  const std::vector<std::string> header = Split(lines[0], ',');
  const auto at = std::ranges::find(header, name) - header.begin();
  std::vector<double> values;
  for (std::size_t i = 1; i < lines.size(); ++i)
    values.push_back(std::stod(Split(lines[i], ',').at(static_cast<std::size_t>(at))));
  return values;
}

double Correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto n = static_cast<double>(a.size());
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sa += a[i];
    sb += b[i];
    saa += a[i] * a[i];
    sbb += b[i] * b[i];
    sab += a[i] * b[i];
  }
  return (n * sab - sa * sb) / std::sqrt((n * saa - sa * sa) * (n * sbb - sb * sb));
}

TEST(AnimFaceExample, GivesTheMotionThatMovedTheMarkers) {
  Context c;
  ASSERT_EQ(c.Run(c.take.weights_csv), 0) << c.output;
  EXPECT_THAT(c.output, HasSubstr("leave-one-out error"));
  EXPECT_THAT(c.output, HasSubstr("8 frames explain 100 % of the motion"));
  const std::string curves = Scratch::Read(c.scratch / "out/curves.csv");
  for (std::size_t shape = 0; shape < c.take.shapes.size(); ++shape) {
    std::vector<double> truth;
    for (const auto& weights : c.take.weights) truth.push_back(static_cast<double>(weights[shape]));
    const std::vector<double> curve = Column(curves, c.take.shapes[shape]);
    ASSERT_EQ(curve.size(), truth.size());
    EXPECT_GT(Correlation(curve, truth), 0.95) << c.take.shapes[shape];
    double error = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) error += std::abs(curve[i] - truth[i]);
    EXPECT_LT(error / static_cast<double>(truth.size()), 0.05) << c.take.shapes[shape];
  }
}

TEST(AnimFaceExample, KeepsTheTakesFramesAndTimes) {
  Context c;
  ASSERT_EQ(c.Run(c.take.weights_csv), 0) << c.output;
  const std::vector<double> times = Column(Scratch::Read(c.scratch / "out/curves.csv"), "t_us");
  ASSERT_EQ(times.size(), c.take.weights.size());
  for (std::size_t i = 0; i < times.size(); ++i)
    EXPECT_NEAR(times[i], static_cast<double>(i) * 1e6 / 60, 1) << i;
  const std::string json = Scratch::Read(c.scratch / "out/curves.jsonl");
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(json, '\n')), times.size());
  EXPECT_EQ(Scratch::Read(c.scratch / "out/curves.glb").substr(0, 4), "glTF");
  EXPECT_EQ(Scratch::Read(c.scratch / "out/training.png").substr(1, 3), "PNG");
}

TEST(AnimFaceExample, NamesTheFrameWhoseValuesAreMissing) {
  Context c;
  EXPECT_EQ(c.Run("frame,jawOpen\n0,0\n"), 2) << c.output;
  EXPECT_THAT(c.output, HasSubstr("column jawOpen is empty"));
}

}  // namespace
}  // namespace facewire
