#include "core/base/name.h"

#include <gtest/gtest.h>

#include <string>

namespace facewire {
namespace {

TEST(ShortName, HoldsTheLongestNameAndNoLonger) {
  const std::string longest(kMaxNameLength, 'a');
  ASSERT_TRUE(ShortName::From(longest));
  EXPECT_EQ(ShortName::From(longest)->view(), longest);
  EXPECT_FALSE(ShortName::From(longest + "a"));
}

TEST(ShortName, RefusesWhatWouldNotReadBack) {
  EXPECT_FALSE(ShortName::From(""));
  EXPECT_FALSE(ShortName::From("jaw open"));
  EXPECT_FALSE(ShortName::From("\xC3\xA9"));
  EXPECT_FALSE(ShortName::From(std::string_view("a\0b", 3)));
}

}  // namespace
}  // namespace facewire
