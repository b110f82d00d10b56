#include "core/base/inline_vector.h"

#include <gtest/gtest.h>

namespace facewire {
namespace {

TEST(InlineVector, FillsExactlyThenRefusesThenRecovers) {
  InlineVector<int, 2> items;
  EXPECT_TRUE(items.try_push(1));
  EXPECT_TRUE(items.try_push(2));
  EXPECT_TRUE(items.full());
  EXPECT_FALSE(items.try_push(3));
  EXPECT_EQ(items[1], 2);
  items.clear();
  EXPECT_TRUE(items.try_push(4));
  EXPECT_EQ(items[0], 4);
}

TEST(InlineVector, ResizingGivesValueInitialisedItems) {
  InlineVector<int, 3> items;
  ASSERT_TRUE(items.try_resize(3));
  items[2] = 7;
  ASSERT_TRUE(items.try_resize(1));
  ASSERT_TRUE(items.try_resize(3));
  EXPECT_EQ(items[2], 0);
  EXPECT_FALSE(items.try_resize(4));
  EXPECT_EQ(items.size(), 3U);
}

}  // namespace
}  // namespace facewire
