#include "tools/markers/take.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "app/error.h"

namespace facewire::tools::markers {
namespace {

using testing::HasSubstr;

std::string ErrorOf(const std::string& path) {
  try {
    (void)ReadTake(path);
  } catch (const app::BadInput& error) {
    return error.what();
  }
  return "no error";
}

std::string Scratch(const std::string& name, const std::string& contents) {
  const std::string path = testing::TempDir() + "take_test_" + name;
  std::ofstream(path, std::ios::binary) << contents;
  return path;
}

TEST(MarkerTake, IsReadByTheEndingOfTheName) {
  EXPECT_EQ(ReadTake(Scratch("upper.CSV", "a_x,a_y,a_z\n1,2,3\n")).frames.size(), 1U);
}

TEST(MarkerTake, NamesTheFileThatIsWrong) {
  EXPECT_THAT(ErrorOf(Scratch("x.fbx", "")),
              HasSubstr("x.fbx: not a marker file; .csv, .trc or .c3d"));
  EXPECT_THAT(ErrorOf("/nowhere/a.csv"), HasSubstr("/nowhere/a.csv: cannot be read"));
  EXPECT_THAT(ErrorOf(Scratch("only_header.csv", "a_x,a_y,a_z\n")), HasSubstr("no frames"));
  EXPECT_THAT(ErrorOf(Scratch("back.csv", "frame,a_x,a_y,a_z\n4,1,2,3\n2,1,2,3\n")),
              HasSubstr("frame 2 comes after frame 4; a recording is in the order of time"));
  EXPECT_THAT(ErrorOf(Scratch("late.csv", "time_s,a_x,a_y,a_z\n4,1,2,3\n2,1,2,3\n")),
              HasSubstr("order of time"));
}

}  // namespace
}  // namespace facewire::tools::markers
