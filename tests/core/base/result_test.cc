#include "core/base/result.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace facewire {
namespace {

Result<int> Half(int n) {
  if (n % 2 != 0) return Errc::kInvalidArgument;
  return n / 2;
}

TEST(Result, IsEitherAValueOrACode) {
  EXPECT_EQ(Half(4).value(), 2);
  EXPECT_EQ(Half(3).error(), Errc::kInvalidArgument);
}

TEST(Errc, EveryCodeHasANameOfItsOwn) {
  std::set<std::string> names;
  for (int code = 1; code <= static_cast<int>(Errc::kSingular); ++code) {
    EXPECT_TRUE(names.insert(Name(static_cast<Errc>(code))).second) << code;
  }
  EXPECT_EQ(names.count("unknown error"), 0U);
}

}  // namespace
}  // namespace facewire
