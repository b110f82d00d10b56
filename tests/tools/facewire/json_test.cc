#include "tools/facewire/json.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace facewire::tools::json {
namespace {

std::string Number(double value, int decimals) {
  std::string out;
  AppendNumber(out, value, decimals);
  return out;
}

TEST(Json, WritesNumbersWithoutNeedlessZeros) {
  EXPECT_EQ(Number(1.5, 3), "1.5");
  EXPECT_EQ(Number(100, 3), "100");
  EXPECT_EQ(Number(-0.12345, 3), "-0.123");
  EXPECT_EQ(Number(-0.0001, 3), "0");
  EXPECT_EQ(Number(100, 0), "100");
}

TEST(Json, WritesNullForWhatJsonHasNoNumberFor) {
  EXPECT_EQ(Number(std::numeric_limits<double>::quiet_NaN(), 3), "null");
  EXPECT_EQ(Number(-std::numeric_limits<double>::infinity(), 3), "null");
}

TEST(Json, WritesTheLargestDouble) {
  EXPECT_EQ(Number(std::numeric_limits<double>::max(), 3).size(), 309U);
}

TEST(Json, EscapesStrings) {
  std::string out;
  AppendString(out, "a\"b\\c\n\x01");
  EXPECT_EQ(out, R"("a\"b\\c\u000a\u0001")");
}

}  // namespace
}  // namespace facewire::tools::json
