#ifndef FACEWIRE_TESTS_APP_NOTIFIED_H_
#define FACEWIRE_TESTS_APP_NOTIFIED_H_

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>

#include <array>
#include <chrono>
#include <cstring>
#include <string>

#include "hal/posix/unique_fd.h"
#include "tests/app/scratch.h"

namespace facewire::app {

// systemd's end of the notify socket.
class Notified {
 public:
  Notified() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    EXPECT_LT(path().size(), sizeof(address.sun_path));
    std::memcpy(address.sun_path, path().c_str(), path().size());
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)),
              0);
  }
  std::string path() const { return scratch_ / "notify"; }

  // Listens until all that was heard so far holds `message`; false when that takes too long.
  bool Until(const std::string& message, std::chrono::seconds limit = std::chrono::seconds(60)) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (heard_.find(message) == std::string::npos) {
      if (std::chrono::steady_clock::now() > end) return false;
      Receive(std::chrono::milliseconds(200));
    }
    return true;
  }
  // What has come since the last call of this or Until.
  std::string Heard() {
    heard_.clear();
    while (Receive(std::chrono::milliseconds(0))) {
    }
    return heard_;
  }

 private:
  bool Receive(std::chrono::milliseconds limit) {
    const timeval wait{limit.count() / 1000, static_cast<suseconds_t>(limit.count() % 1000 * 1000)};
    ::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof(wait));
    std::array<char, 1024> buffer;
    const int flags = limit.count() == 0 ? MSG_DONTWAIT : 0;
    const ssize_t size = ::recv(socket_.get(), buffer.data(), buffer.size(), flags);
    if (size <= 0) return false;
    heard_ += std::string(buffer.data(), static_cast<std::size_t>(size)) + "\n";
    return true;
  }

  Scratch scratch_;
  hal::posix::UniqueFd socket_;
  std::string heard_;
};

// How often the watchdog was fed.
inline int BeatsIn(const std::string& heard) {
  int beats = 0;
  for (std::size_t at = 0; (at = heard.find("WATCHDOG=1\n", at)) != std::string::npos; ++at) {
    ++beats;
  }
  return beats;
}

}  // namespace facewire::app

#endif  // FACEWIRE_TESTS_APP_NOTIFIED_H_
