#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <map>

#include "core/landmarks.h"
#include "tests/app/facewired.h"

// The program itself and real footage: a host that asks sees the face that the picture shows.
namespace facewire::app {
namespace {

struct Picture {
  std::array<wire::LandmarkPoint, kMaxLandmarks> points{};
  std::size_t known = 0;
};

// Whole ones, by their number.
std::map<std::uint32_t, Picture> PicturesOf(const std::vector<wire::LandmarkPart>& parts) {
  std::map<std::uint32_t, Picture> pictures;
  for (const wire::LandmarkPart& part : parts) {
    Picture& picture = pictures[part.frame_seq];
    for (std::size_t i = 0; i < part.points.size(); ++i) {
      picture.points.at(part.first + i) = part.points[i];
      ++picture.known;
    }
  }
  std::erase_if(pictures, [](const auto& p) { return p.second.known != kMaxLandmarks; });
  return pictures;
}

TEST(FacewiredLandmarks, AreThoseOfTheFaceInThePictureAndOnlyForAHostThatAsks) {
  Facewired f(Configuration());
  Process process = f.Start({"--fake"});
  Listener host(f.scratch / "line");
  ASSERT_TRUE(host.Until([&] { return host.state() == ServiceState::kTracking; }));
  EXPECT_TRUE(host.parts.empty());
  ASSERT_TRUE(host.Say({.id = 1, .code = wire::CommandCode::kLandmarks, .value = 30}));
  ASSERT_TRUE(host.Until([&] { return PicturesOf(host.parts).size() >= 20; }));
  EXPECT_EQ(host.parts.back().width_px, 360U) << "of the footage";
  EXPECT_EQ(host.parts.back().height_px, 288U);
  for (const auto& [seq, picture] : PicturesOf(host.parts)) {
    // Numbers of the canonical mesh: outer corners of the eyes (the performer's right one lies to
    // the left in the picture), the tip of the nose, forehead and chin.
    const auto& p = picture.points;
    EXPECT_LT(p[33].x_eighth_px, p[1].x_eighth_px) << seq;
    EXPECT_LT(p[1].x_eighth_px, p[263].x_eighth_px) << seq;
    EXPECT_LT(p[10].y_eighth_px, p[1].y_eighth_px) << seq;
    EXPECT_LT(p[1].y_eighth_px, p[152].y_eighth_px) << seq;
    // A face that fills about half of the picture's height, within the picture.
    EXPECT_GT(p[152].y_eighth_px - p[10].y_eighth_px, 8 * 288 / 4) << seq;
    EXPECT_GT(p[10].y_eighth_px, 0) << seq;
    EXPECT_LT(p[152].y_eighth_px, 8 * 288) << seq;
  }
  EXPECT_EQ(host.stats().Damaged(), 0U);
  process.Signal(SIGTERM);
  EXPECT_EQ(process.Wait(), 0) << process.err();
}

}  // namespace
}  // namespace facewire::app
