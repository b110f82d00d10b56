#ifndef FACEWIRE_APP_CONTROL_H_
#define FACEWIRE_APP_CONTROL_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "app/request.h"
#include "core/wire/decoder.h"
#include "core/wire/encoder.h"
#include "hal/local/local_listener.h"
#include "hal/posix/unique_fd.h"

namespace facewire::app {

struct ControlCounters {
  std::uint64_t clients = 0;  // that came
  std::uint64_t dropped = 0;  // sent away: flooding, stuck, or making room
};

// The service's end of the control socket: commands in, acknowledgements out, in the frames of
// core/wire, for a few clients at once. Costs a tick a few system calls, whatever the clients do:
// nothing waits, and nothing allocates after Open.
//
// A client is sent away when more arrives from it in a tick than anybody types or a program of ours
// sends (kMaxBytesPerTick), or when it does not read its answers. Bytes that are no frames are no
// reason. When all places are taken, a newcomer gets that of the client which has been silent for
// longest: an operator must get in however many terminals were forgotten.
class Control {
 public:
  static constexpr std::size_t kMaxClients = 4;
  static constexpr std::size_t kMaxBytesPerTick = 255;  // 14 commands

  // Errors as LocalListener::Open.
  Result<> Open(const std::string& path) { return listener_.Open(path); }

  // Once a tick: takes newcomers, and what has arrived.
  void Poll() noexcept;
  // The next command of this tick.
  std::optional<Request> Next() noexcept;
  // To the client, if it is still there; `text` in as many parts as it takes.
  void Say(Asker asker, std::uint16_t id, std::string_view text) noexcept;
  void Answer(Asker asker, const wire::Acknowledgement& answer) noexcept;

  const ControlCounters& counters() const noexcept { return counters_; }

 private:
  struct Client {
    hal::posix::UniqueFd fd;  // none: the place is free
    Asker number = 0;
    std::uint64_t heard = 0;  // the tick in which it came, or something arrived from it
    wire::Decoder decoder;
    wire::Encoder encoder;
    std::array<std::byte, kMaxBytesPerTick + 1> in{};
    std::span<const std::byte> unread;  // part of `in`
  };
  Client& PlaceForNewcomer() noexcept;
  void Read(Client& client) noexcept;
  void Drop(Client& client) noexcept;
  Client* Find(Asker asker) noexcept;
  template <class Message>
  void Send(Client& client, const Message& message) noexcept;

  hal::local::LocalListener listener_;
  std::array<Client, kMaxClients> clients_;
  std::uint64_t tick_ = 0;
  Asker next_number_ = kFirstClient;
  ControlCounters counters_;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_CONTROL_H_
