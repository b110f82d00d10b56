#include "tools/facewire/report_text.h"

#include <gtest/gtest.h>

#include <string>

namespace facewire::tools {
namespace {

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
