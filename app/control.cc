#include "app/control.h"

#include <algorithm>
#include <utility>

#include "hal/local/local_socket.h"

namespace facewire::app {

void Control::Poll() noexcept {
  if (!listener_.is_open()) return;
  ++tick_;
  // As many as there are places: a stream of newcomers must not hold up the tick.
  for (std::size_t i = 0; i < kMaxClients; ++i) {
    Result<hal::posix::UniqueFd> newcomer = listener_.Accept();
    if (!newcomer) break;
    Client& place = PlaceForNewcomer();
    if (place.fd) Drop(place);
    place.fd = std::move(*newcomer);
    place.number = next_number_;
    place.heard = tick_;
    next_number_ = std::max(next_number_ + 1, kFirstClient);
    ++counters_.clients;
  }
  for (Client& client : clients_) Read(client);
}

Control::Client& Control::PlaceForNewcomer() noexcept {
  const auto free = std::ranges::find_if(clients_, [](const Client& c) { return !c.fd; });
  return free != clients_.end() ? *free : *std::ranges::min_element(clients_, {}, &Client::heard);
}

void Control::Read(Client& client) noexcept {
  if (!client.fd) return;
  const Result<std::size_t> count = hal::local::TryReceive(client.fd.get(), client.in);
  if (!count) {
    if (count.error() != Errc::kNotReady) client = {};  // it has gone by itself
    return;
  }
  if (*count > kMaxBytesPerTick) {
    Drop(client);
    return;
  }
  client.heard = tick_;
  client.unread = std::span(client.in).first(*count);
}

void Control::Drop(Client& client) noexcept {
  client = {};
  ++counters_.dropped;
}

std::optional<Request> Control::Next() noexcept {
  for (Client& client : clients_) {
    while (!client.unread.empty()) {
      const auto received = client.decoder.Next(client.unread);
      if (!received) continue;  // damage is the decoder's; the loop ends with the bytes
      if (const auto* command = std::get_if<wire::Command>(&received->message)) {
        return Request{.command = *command, .asker = client.number};
      }
    }
  }
  return std::nullopt;
}

// Null when it has gone.
Control::Client* Control::Find(Asker asker) noexcept {
  const auto client = std::ranges::find_if(
      clients_, [asker](const Client& c) { return c.fd && c.number == asker; });
  return client == clients_.end() ? nullptr : &*client;
}

void Control::Say(Asker asker, std::uint16_t id, std::string_view text) noexcept {
  while (!text.empty()) {
    Client* client = Find(asker);
    if (client == nullptr) return;
    const std::string_view part = text.substr(0, wire::kMaxTextBytes);
    wire::Text message{.id = id};
    if (message.text.try_resize(part.size())) std::ranges::copy(part, message.text.begin());
    Send(*client, message);
    text.remove_prefix(part.size());
  }
}

void Control::Answer(Asker asker, const wire::Acknowledgement& answer) noexcept {
  if (Client* client = Find(asker)) Send(*client, answer);
}

template <class Message>
void Control::Send(Client& client, const Message& message) noexcept {
  std::array<std::byte, wire::kTextFrameBytes> out;
  const auto frame = client.encoder.Encode(message, out);
  if (!frame) return;
  // A frame is far smaller than the socket's buffer: one that does not fit waits behind hundreds
  // that nobody reads.
  const Result<std::size_t> sent = hal::local::TrySend(client.fd.get(), *frame);
  if (!sent || *sent < frame->size()) Drop(client);
}

}  // namespace facewire::app
