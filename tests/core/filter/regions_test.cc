#include "core/filter/regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace facewire::filter {
namespace {

TEST(Regions, NoLandmarkIsListedTwice) {
  std::set<int> all;
  for (auto i : kLidLandmarks) EXPECT_TRUE(all.insert(i).second) << i;
  for (auto i : kIrisLandmarks) EXPECT_TRUE(all.insert(i).second) << i;
  for (auto i : kLipLandmarks) EXPECT_TRUE(all.insert(i).second) << i;
  EXPECT_LT(*all.rbegin(), static_cast<int>(kMaxLandmarks));
}

TEST(Regions, TheTableSaysWhatTheListsSay) {
  EXPECT_EQ(std::ranges::count(kRegionOf, Region::kEyes), 74);
  EXPECT_EQ(std::ranges::count(kRegionOf, Region::kMouth), 80);
  EXPECT_EQ(kRegionOf[386], Region::kEyes);  // an upper lid
  EXPECT_EQ(kRegionOf[473], Region::kEyes);  // a pupil
  EXPECT_EQ(kRegionOf[13], Region::kMouth);  // the upper lip's inner edge
  EXPECT_EQ(kRegionOf[4], Region::kRest);    // the nose's tip
  EXPECT_EQ(kRegionOf[105], Region::kRest);  // a brow
  EXPECT_EQ(kRegionOf[152], Region::kRest);  // the chin
}

}  // namespace
}  // namespace facewire::filter
