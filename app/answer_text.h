#ifndef FACEWIRE_APP_ANSWER_TEXT_H_
#define FACEWIRE_APP_ANSWER_TEXT_H_

#include <array>

#include "core/wire/message.h"

namespace facewire::app {

// What an answer means to a person, and what would be right: one sentence without a line end. The
// journal and the operator's terminal say the same. Allocates nothing.
std::array<char, 160> AnswerText(const wire::Acknowledgement& answer) noexcept;

}  // namespace facewire::app

#endif  // FACEWIRE_APP_ANSWER_TEXT_H_
