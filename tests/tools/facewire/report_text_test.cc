#include "tools/facewire/report_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace facewire::tools {
namespace {

using testing::HasSubstr;

TEST(ReportText, TellsHowTheLineFared) {
  const auto text = ReportText(
      R"({"state":"tracking","reason":"","line":"serial:/dev/ttyUSB0","line_state":"up","poses_sent":900,)"
      R"("poses_dropped":2,"line_bytes":123456,"line_errors":1,"line_losses":3,"line_reopens":3})");
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("serial:/dev/ttyUSB0: up, 900 poses, 2 not taken, 123456 bytes, 1 errors, "
                       "lost 3 times, opened again 3 times\n"),
            std::string::npos)
      << *text;
}

TEST(ReportText, HasALineForEachBusAndServo) {
  const auto text = ReportText(
      R"({"state":"tracking","buses":[{"name":"face","kind":"feetech","port":"serial:/dev/x",)"
      R"("port_state":"up","state":"running","fault":"","questions":9,"lost":1,"losses":2}],)"
      R"("servos":[{"name":"jaw","bus":"face","id":1,"state":"on","activity":"following",)"
      R"("commanded":1500.25,"position":1500,"temperature_c":58,"load":-0.5,"voltage_v":7.4,)"
      R"("reason":"heat","faults":""},)"
      R"({"name":"brow","bus":"face","id":2,"state":"absent","activity":"waiting",)"
      R"("commanded":0,"reason":"does not answer","faults":""}],"frames":3})");
  ASSERT_TRUE(text);
  EXPECT_THAT(*text, HasSubstr("bus      face: feetech, serial:/dev/x: up, running, 9 questions, 1 "
                               "without an answer, lost 2 times\n"));
  EXPECT_THAT(*text, HasSubstr("servo    jaw (face 1)             on, following        at    1500, "
                               "told 1500.25  58 C, load  -0.5  7.4 V, heat\n"));
  EXPECT_THAT(*text, HasSubstr("servo    brow (face 2)            absent, waiting      at       -, "
                               "told       0     -, load     -      -, does not answer\n"));
}

TEST(ReportText, HasNothingToTellOfNoLine) {
  const auto text = ReportText(R"({"state":"searching","line_state":"none","poses_sent":0})");
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("line     none\n"), std::string::npos) << *text;
}

TEST(ReportText, WhatAnOlderServiceDoesNotSayIsAQuestionMark) {
  const auto text = ReportText(R"({"state":"searching"})");
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("? poses"), std::string::npos) << *text;
}

TEST(ReportText, WhatIsNoReportIsRefused) {
  EXPECT_FALSE(ReportText(""));
  EXPECT_FALSE(ReportText(R"({"state":"searching")"));
}

}  // namespace
}  // namespace facewire::tools
