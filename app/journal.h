#ifndef FACEWIRE_APP_JOURNAL_H_
#define FACEWIRE_APP_JOURNAL_H_

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "hal/posix/unique_fd.h"

namespace facewire::app {

// What the service tells the journal. The names and numbers are a contract with whoever filters by
// them (systemd/README.md, systemd/facewire.catalog): append only.
enum class Event : std::uint8_t {
  kReady,              // the devices are open and the service ticks
  kSearching,          // the first search for a face after the start; how long it took
  kState,              // another state
  kStopped,            // an emergency stop, and by whom
  kFault,              // a camera or a line is gone
  kStopNotKept,        // a restart may forget the emergency stop
  kStopRemembered,     // stopped from before the start
  kNeutralKept,        // a calibration was stored
  kNeutralNotKept,     // a calibration lasts until the restart
  kNeutralUnusable,    // the stored neutral cannot be used
  kStorageUnwritable,  // the state folder cannot be written
  kReloaded,           // the configuration was read again
  kReloadProblem,      // a mistake in the configuration; the old one runs on
  kNoControl,          // there is no control socket
  kButtonPress,        // what a press of the button came to
  kStarving,           // the watchdog is not fed any more, and why
  kRecovered,          // the watchdog is fed again
  kBadInput,           // a mistake in the configuration; not started
  kFailure,            // something failed; not started, or ended
  kEnded,              // a summary of the run
  kBoardLine,          // what a GPIO line did, or why it fails
  kServoBus,           // a servo bus is lost, or back
  kServo,              // a servo is lost, hot, refused, or well again
};

struct EventKind {
  Event event;
  const char* name;  // FACEWIRE_EVENT
  const char* id;    // MESSAGE_ID
  int priority;      // as in syslog(3): 2 critical, 3 error, 4 warning, 5 notice, 6 information
};
// All of them, in the order of Event.
std::span<const EventKind> EventKinds() noexcept;

// Writes to systemd's journal, with fields to filter by (Native Journal Protocol: one datagram an
// entry), when stderr is the journal's; else lines of plain text to stderr. Neither waits nor
// allocates: an entry that the journal has no room for goes to stderr.
class Journal {
 public:
  // Looks at JOURNAL_STREAM, as sd_journal_stream(3) says.
  Journal() noexcept;
  // To this socket, whatever stderr is.
  explicit Journal(const std::string& socket) noexcept;

  bool structured() const noexcept { return static_cast<bool>(socket_); }
  // Every entry from now on carries this state, a string that lasts. FACEWIRE_STATE.
  void SetState(const char* state) noexcept { state_ = state; }

  // One entry for each line of `text`. `reason` is why, in words (FACEWIRE_REASON), or empty. The
  // last three are the caller's place in the program; leave them out.
  void Write(Event event, std::string_view text, std::string_view reason = {},
             const char* file = __builtin_FILE(), int line = __builtin_LINE(),
             const char* function = __builtin_FUNCTION()) noexcept;

 private:
  bool Connect(const std::string& path) noexcept;

  hal::posix::UniqueFd socket_;
  const char* state_ = "starting";
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_JOURNAL_H_
