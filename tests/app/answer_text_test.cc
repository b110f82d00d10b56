#include "app/answer_text.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace facewire::app {
namespace {

using wire::CommandCode;
using wire::CommandResult;

std::string Text(CommandResult result, float measure = 0,
                 CommandCode code = CommandCode::kCalibrateNeutral) {
  return AnswerText({.code = code, .result = result, .measure = measure}).data();
}

TEST(AnswerText, SaysWhatMovedByHowMuchAndWhatToDo) {
  EXPECT_EQ(Text(CommandResult::kHeadTurned, 8.2F),
            "hold still: the head turned by 8 degrees within the second");
  EXPECT_EQ(Text(CommandResult::kHeadMoved, 1.52F),
            "hold still: the head moved by 1.5 cm within the second");
  EXPECT_EQ(Text(CommandResult::kFaceMoved, 0.31F),
            "keep the face still: it moved by 0.3 cm within the second");
  EXPECT_EQ(Text(CommandResult::kEyesClosed, 0.72F),
            "do not blink: an eye closed to 0.72 of its way within the second");
  EXPECT_EQ(Text(CommandResult::kEyesClosed, 1), "open the eyes: they were closed");
  EXPECT_EQ(Text(CommandResult::kMouthOpen, 0.31F),
            "close the mouth: the lips stand apart by 0.31 of its width");
}

TEST(AnswerText, HasALineForWhateverADeviceAnswers) {
  for (int code = 0; code <= 255; ++code) {
    for (int result = 0; result <= 255; ++result) {
      const std::string text =
          Text(static_cast<CommandResult>(result), 1e30F, static_cast<CommandCode>(code));
      ASSERT_FALSE(text.empty());
      ASSERT_EQ(text.find_first_of("\n%"), result == 2 && code == 7 ? text.find('%') : text.npos)
          << text;
    }
  }
  EXPECT_EQ(Text(static_cast<CommandResult>(77)), "failed, with result 77");
}

}  // namespace
}  // namespace facewire::app
