#include "tools/facewire/servo/live.h"

#include <chrono>
#include <cstdint>

#include "app/answer_text.h"
#include "app/error.h"
#include "tools/facewire/command_client.h"
#include "tools/facewire/open_service.h"

namespace facewire::tools {
namespace {

// A hand counts for the rig's `fresh`, 200 ms unless it says otherwise.
constexpr std::chrono::milliseconds kRepeat(50);
constexpr std::chrono::seconds kAnswersWithin(5);

}  // namespace

void HoldLive(const Installation& all, std::size_t servo, float position, Duration longest,
              hal::Clock& clock, const std::function<bool()>& stop) {
  if (all.control.empty()) {
    throw app::BadInput("the service has no control socket ([control] socket = \"\")");
  }
  const auto port = OpenService(all.control.string(), 0);
  CommandClient client(all.control.string(), *port, clock);
  const wire::Command move{.code = wire::CommandCode::kMoveServo,
                           .value = position,
                           .item = static_cast<std::uint8_t>(servo)};
  std::optional<wire::Acknowledgement> answer = client.Ask(move, kAnswersWithin);
  for (const Time end = clock.Now() + longest; clock.Now() < end && !stop();) {
    if (answer && !Succeeded(answer->result)) throw app::Failure(app::AnswerText(*answer).data());
    clock.SleepUntil(clock.Now() + kRepeat / 2);
    answer = client.Say(move, kRepeat / 2);
  }
  if (answer && !Succeeded(answer->result)) throw app::Failure(app::AnswerText(*answer).data());
}

}  // namespace facewire::tools
