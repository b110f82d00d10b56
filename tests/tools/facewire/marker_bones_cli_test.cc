// `facewire retarget` with markers and no profile: the geometry mapping moves the bones that name
// markers, whatever the markers are called and however many frames a second there are.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/generated_markers.h"
#include "tests/tools/facewire/run.h"

namespace facewire::tools {
namespace {

using test::MarkerPoints;
using testing::HasSubstr;

std::string Format(Point3 p) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.5f,%.5f,%.5f", p.x, p.y, p.z);
  return text.data();
}

using Naming = std::function<std::string(std::size_t)>;

std::string Take(const Naming& name, int rate_hz, int frames) {
  std::string csv = "time_s";
  for (std::size_t i = 0; i < test::kMarkerCount; ++i) {
    for (const char* axis : {"_x", "_y", "_z"}) csv += "," + name(i) + axis;
  }
  csv += "\n";
  for (int f = 0; f < frames; ++f) {
    const float t = static_cast<float>(f) / static_cast<float>(rate_hz);
    csv += std::to_string(t);
    for (const Point3 p : test::PerformingMarkers(t)) csv += "," + Format(p);
    csv += "\n";
  }
  return csv;
}

// Twice as large, longer below the eyes, and wide at the jaw.
Point3 Character(Point3 p) {
  return {2 * p.x * (1 - 0.03F * p.y), 2 * p.y - std::log1p(std::exp(3 - p.y)), 2.2F * p.z};
}

std::string RigOf(const Naming& name, std::size_t bones) {
  const MarkerPoints neutral = test::NeutralMarkers();
  std::string toml = "name = \"character\"\n";
  for (std::size_t i = 0; i < bones; ++i) {
    toml += "[[bone]]\nname = \"b" + std::to_string(i) + "\"\nmarker = \"" + name(i) +
            "\"\nrest_cm = [" + Format(Character(neutral[i])) + "]\n";
    for (const char* axis : {"x", "y", "z"})
      toml += std::string(axis) + " = { min = -20, max = 20 }\n";
  }
  return toml;
}

// Mean error of the bones over their mean motion, in a CSV of poses.
double ErrorOf(const std::string& csv, int rate_hz, std::size_t bones) {
  constexpr std::size_t kBefore = 9;  // frame, t_us, state and the head
  const MarkerPoints neutral = test::NeutralMarkers();
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  double error = 0;
  double motion = 0;
  for (int f = 0; std::getline(lines, line); ++f) {
    std::vector<float> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');)
      cells.push_back(std::strtof(cell.c_str(), nullptr));
    EXPECT_EQ(cells.size(), kBefore + 3 * bones);
    if (cells.size() != kBefore + 3 * bones) return 1;
    const MarkerPoints now =
        test::PerformingMarkers(static_cast<float>(f) / static_cast<float>(rate_hz));
    for (std::size_t i = 0; i < bones; ++i) {
      const Point3 truth = Character(now[i]) - Character(neutral[i]);
      const std::size_t at = kBefore + 3 * i;
      const Point3 off = Point3{cells[at], cells[at + 1], cells[at + 2]} - truth;
      error += std::sqrt(Dot(off, off));
      motion += std::sqrt(Dot(truth, truth));
    }
  }
  return motion > 0 ? error / motion : 1;
}

struct Case {
  const char* what;
  Naming name;
  int rate_hz;
  std::size_t bones;
};

TEST(FacewireRetargetWithoutProfile, MovesBonesWithTheMarkersThatTheyName) {
  const std::vector<Case> cases = {
      {"all markers of a take of 100 frames a second",
       [](std::size_t i) { return "L" + std::to_string(i); }, 100, 68},
      {"some markers, 30 frames a second",
       [](std::size_t i) { return "Face:" + std::to_string(i); }, 30, 60},
      // As if they were landmarks 100 to 167 of the face mesh.
      {"landmarks by the names of their markers",
       [](std::size_t i) { return "lm" + std::to_string(100 + i); }, 60, 68},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.what);
    const Scratch scratch;
    const Outcome outcome =
        RunFacewire({"retarget", scratch.Write("m.csv", Take(c.name, c.rate_hz, 3 * c.rate_hz)),
                     "--rig", scratch.Write("rig.toml", RigOf(c.name, c.bones)), "--neutral", "0:1",
                     "--out", scratch.Path("out.csv")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const double error = ErrorOf(scratch.Read("out.csv"), c.rate_hz, c.bones);
    std::printf("%s: error %.1f %% of the motion\n", c.what, 100 * error);
    EXPECT_LE(error, 0.15);
  }
}

TEST(FacewireRetargetWithoutProfile, NamesTheMarkersThatTheRigMisses) {
  const auto name = [](std::size_t i) { return "L" + std::to_string(i); };
  const Scratch scratch;
  const Outcome outcome =
      RunFacewire({"retarget", scratch.Write("m.csv", "L0_x,L0_y,L0_z\n0,-8,4\n"), "--rig",
                   scratch.Write("rig.toml", RigOf(name, 3)), "--neutral", "0:1", "--out",
                   scratch.Path("out.csv")});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("the rig: there is no marker L1"));
  EXPECT_THAT(outcome.err, HasSubstr("no L2"));
}

TEST(FacewireRetargetWithoutProfile, SaysWhyAParameterCannotMove) {
  const Scratch scratch;
  const std::string take = scratch.Write("m.csv", "L0_x,L0_y,L0_z\n0,-8,4\n");
  const auto complaint = [&](const std::string& rig) {
    const Outcome outcome = RunFacewire({"retarget", take, "--rig", scratch.Write("rig.toml", rig),
                                         "--neutral", "0:1", "--out", scratch.Path("out.csv")});
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  };
  EXPECT_THAT(complaint("name = \"r\"\n[[parameter]]\nname = \"jawOpen\"\n"),
              HasSubstr("the signal jawOpen is driven by, but there is none without --profile"));
  EXPECT_THAT(complaint("name = \"r\"\n[[bone]]\nname = \"neck\"\nyaw = { min = -1, max = 1, drive "
                        "= { \"head.yaw\" = 1 } }\n"),
              HasSubstr("no bone has a marker"));
}

}  // namespace
}  // namespace facewire::tools
