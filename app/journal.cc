#include "app/journal.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace facewire::app {
namespace {

constexpr const char* kSocket = "/run/systemd/journal/socket";
constexpr std::array<EventKind, 23> kKinds = {{
    {Event::kReady, "ready", "cfbb39a722834f90b1acec2029de4891", 6},
    {Event::kSearching, "searching", "ca55979e587e4155a6ab52450309041c", 6},
    {Event::kState, "state", "3718b0ea97294539811e03f1635db321", 6},
    {Event::kStopped, "stopped", "42500af926fc48468a84cc2cc9b64f95", 4},
    {Event::kFault, "fault", "c1b2817d89f041088debb71c702d8f46", 4},
    {Event::kStopNotKept, "stop_not_kept", "90cec399775b4523a2f866dc486b1b32", 3},
    {Event::kStopRemembered, "stop_remembered", "5c5cd8d6125742db91882a3f9b98c16d", 4},
    {Event::kNeutralKept, "neutral_kept", "f22c6f48fe934a14afd602e0e02e9964", 5},
    {Event::kNeutralNotKept, "neutral_not_kept", "ae99020587944ea49fb72833fa56a017", 4},
    {Event::kNeutralUnusable, "neutral_unusable", "c2bf8c98fc6a488db6b3ab265d4ca0f3", 4},
    {Event::kStorageUnwritable, "storage_unwritable", "7da78359ef6b4dc2994b279cc9e51b41", 4},
    {Event::kReloaded, "reloaded", "bd49e087e79f4d4e8396fc4f8c8c6ed3", 5},
    {Event::kReloadProblem, "reload_problem", "9f1de40fec3a438e9f9b426c8ae22c3a", 3},
    {Event::kNoControl, "no_control", "a49561702252476299891be5b5d0484e", 4},
    {Event::kButtonPress, "button", "87acc512c3ee4ba08d8414f3742694a0", 6},
    {Event::kStarving, "starving", "6fe5ecdec91d4dc7b9ffef91ed95e9db", 2},
    {Event::kRecovered, "recovered", "38fac0ec1d7c42aeb2ad27a216b04b9b", 5},
    {Event::kBadInput, "bad_input", "63e0a647920c427a95941242bf14f15a", 3},
    {Event::kFailure, "failure", "f2865d6f91ff4b59bfb2f7b95cc81c21", 3},
    {Event::kEnded, "ended", "8de7b38d27c143bb83bc80ede288d12d", 6},
    {Event::kBoardLine, "board_line", "9179c9dc6fb1456e8a80dabf637a56d5", 4},
    {Event::kServoBus, "servo_bus", "2f7e263c25f74f8ab2d3fedbf9e1fd32", 4},
    {Event::kServo, "servo", "8aa4f4cb8bbf40c6830c0e593d857dbd", 4},
}};

// The longest line and reason that are written; what is longer is cut.
constexpr int kMaxText = 800;

// JOURNAL_STREAM is "device:inode" of the stream that systemd connected to the journal.
bool StderrIsTheJournal() noexcept {
  const char* stream = std::getenv("JOURNAL_STREAM");
  std::uintmax_t device = 0;
  std::uintmax_t inode = 0;
  struct stat node {};
  return stream != nullptr && std::sscanf(stream, "%" SCNuMAX ":%" SCNuMAX, &device, &inode) == 2 &&
         ::fstat(STDERR_FILENO, &node) == 0 && node.st_dev == device && node.st_ino == inode;
}

int Shown(std::string_view text) noexcept {
  return static_cast<int>(std::min<std::size_t>(text.size(), kMaxText));
}

void WritePlain(std::string_view text) noexcept {
  std::array<char, kMaxText + 32> line;
  const int size =
      std::snprintf(line.data(), line.size(), "facewired: %.*s\n", Shown(text), text.data());
  if (size <= 0) return;
  const auto shown = std::min(static_cast<std::size_t>(size), line.size() - 1);
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, line.data(), shown);
}

}  // namespace

std::span<const EventKind> EventKinds() noexcept { return kKinds; }

Journal::Journal() noexcept {
  if (StderrIsTheJournal()) (void)Connect(kSocket);
}

Journal::Journal(const std::string& socket) noexcept { (void)Connect(socket); }

bool Journal::Connect(const std::string& path) noexcept {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof(address.sun_path)) return false;
  std::memcpy(address.sun_path, path.c_str(), path.size());
  hal::posix::UniqueFd socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): the sockets' own interface
  const auto* to = reinterpret_cast<const sockaddr*>(&address);
  if (!socket || ::connect(socket.get(), to, sizeof(address)) != 0) return false;
  socket_ = std::move(socket);
  return true;
}

void Journal::Write(Event event, std::string_view text, std::string_view reason, const char* file,
                    int line, const char* function) noexcept {
  const EventKind& kind = kKinds[static_cast<std::size_t>(event)];
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view words = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (words.empty()) continue;
    std::array<char, 2 * kMaxText + 600> entry;
    const int size =
        std::snprintf(entry.data(), entry.size(),
                      "MESSAGE=%.*s\nMESSAGE_ID=%s\nPRIORITY=%d\nSYSLOG_IDENTIFIER=facewired\n"
                      "FACEWIRE_EVENT=%s\nFACEWIRE_STATE=%s\nCODE_FILE=%.200s\nCODE_LINE=%d\n"
                      "CODE_FUNC=%.100s\n%s%.*s%s",
                      Shown(words), words.data(), kind.id, kind.priority, kind.name, state_, file,
                      line, function, reason.empty() ? "" : "FACEWIRE_REASON=", Shown(reason),
                      reason.data(), reason.empty() ? "" : "\n");
    if (!socket_ || size <= 0 || static_cast<std::size_t>(size) >= entry.size() ||
        ::send(socket_.get(), entry.data(), static_cast<std::size_t>(size),
               MSG_DONTWAIT | MSG_NOSIGNAL) < 0) {
      WritePlain(words);
    }
  }
}

}  // namespace facewire::app
