#include "tools/facewire/landmark_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/app/scratch.h"
#include "tests/support/generated_face.h"

namespace facewire::tools {
namespace {

using app::BadInputOf;
using app::Scratch;
using testing::HasSubstr;
using testing::StartsWith;

Sighting Seen(std::uint64_t frame) {
  Sighting sighting{frame, static_cast<std::int64_t>(frame) * 33333, std::nullopt};
  sighting.face = test::Photograph(test::GeneratedFace(), {});
  sighting.face->presence = 0.75F;
  return sighting;
}

// What is wrong with a file of this text, which is read to its end.
std::string ErrorOf(const std::string& text) {
  const Scratch scratch;
  return BadInputOf([&] {
    LandmarkFile file(scratch.Write("f.jsonl", text));
    while (file.Next()) {
    }
  });
}

TEST(LandmarkFile, GivesBackWhatWasWritten) {
  const Scratch scratch;
  LandmarkFile file(scratch.Write("f.jsonl", LandmarkLine(Seen(3)) + LandmarkLine({4, 133333, {}}) +
                                                 "\n" + LandmarkLine(Seen(9))));
  const Sighting expected = Seen(3);
  const auto first = file.Next();
  ASSERT_TRUE(first && first->face);
  EXPECT_EQ(first->frame, 3U);
  EXPECT_EQ(first->t_us, 99999);
  EXPECT_EQ(first->face->seq, 3U);
  EXPECT_EQ(first->face->captured, Time{Duration{99999}});
  EXPECT_EQ(first->face->width_px, 640);
  EXPECT_EQ(first->face->height_px, 480);
  EXPECT_EQ(first->face->presence, 0.75F);
  ASSERT_EQ(first->face->count, kMaxLandmarks);
  for (std::size_t i = 0; i < kMaxLandmarks; ++i) {
    EXPECT_NEAR(first->face->points_px[i].x, expected.face->points_px[i].x, 6e-4) << i;
    EXPECT_NEAR(first->face->points_px[i].z, expected.face->points_px[i].z, 6e-4) << i;
  }
  const auto lost = file.Next();
  ASSERT_TRUE(lost);
  EXPECT_FALSE(lost->face);
  EXPECT_TRUE(file.Next()->face);
  EXPECT_FALSE(file.Next());
}

TEST(LandmarkFile, TakesOtherKeysAndNoPresence) {
  const Scratch scratch;
  std::string line = LandmarkLine(Seen(0));
  line = app::Replaced(line, "\"presence\":0.75", "\"id\":\"neutral_00\",\"weights\":{\"a\":[1]}");
  LandmarkFile file(scratch.Write("f.jsonl", line));
  EXPECT_EQ(file.Next()->face->presence, 1);
}

TEST(LandmarkFile, SaysWhichLineIsWrongAndWhy) {
  const std::string good = LandmarkLine(Seen(5));
  EXPECT_THAT(ErrorOf(good + "{\"frame\":6"),
              HasSubstr("f.jsonl:2: not a line of `facewire track`"));
  EXPECT_THAT(ErrorOf("{\"frame\":0,\"t_us\":0,\"markers\":{}}\n"), HasSubstr("not a line of"));
  EXPECT_THAT(ErrorOf("{\"frame\":0,\"t_us\":0,\"landmarks\":[[1,2]]}\n"), HasSubstr("not a line"));
  EXPECT_THAT(ErrorOf("{\"frame\":0,\"t_us\":0,\"landmarks\":[[1,2,3]]}\n"),
              HasSubstr("f.jsonl:1: 1 landmarks; 468 or 478 would be right"));
  EXPECT_THAT(ErrorOf("{\"frame\":-1,\"t_us\":0,\"landmarks\":null}\n"),
              HasSubstr("whole numbers"));
  EXPECT_THAT(ErrorOf("{\"t_us\":0,\"landmarks\":null}\n"), HasSubstr("whole numbers"));
  EXPECT_THAT(ErrorOf(good + good), HasSubstr("f.jsonl:2: frame 5 comes after frame 5"));
  EXPECT_THAT(ErrorOf(good + LandmarkLine({6, 0, {}})), HasSubstr("before that of the line above"));
  EXPECT_THAT(ErrorOf(app::Replaced(good, "\"width\":640,", "")),
              HasSubstr("the size of the picture"));
  EXPECT_THAT(BadInputOf([] { LandmarkFile file("/nowhere.jsonl"); }),
              StartsWith("/nowhere.jsonl"));
}

}  // namespace
}  // namespace facewire::tools
