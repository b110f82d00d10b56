#ifndef FACEWIRE_TOOLS_FACEWIRE_LINE_SERVER_H_
#define FACEWIRE_TOOLS_FACEWIRE_LINE_SERVER_H_

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace facewire::tools {

// A web server that has static files, and a line's bytes as WebSocket at "/line": binary messages
// of any length, both ways, for as many viewers as come (up to kMaxViewers). Not thread-safe; one
// at a time in a process.
class LineServer {
 public:
  static constexpr std::size_t kMaxViewers = 16;
  // What waits for a viewer whose network is slow; more, and the oldest goes. The protocol finds
  // its way again.
  static constexpr std::size_t kMaxWaiting = std::size_t{64} * 1024;

  struct Config {
    std::string address = "127.0.0.1";  // of this machine; "0.0.0.0" for all of them
    int port = 8080;                    // 0: any that is free
    std::filesystem::path files;        // the folder; it has index.html
  };

  // Throws Failure when it cannot listen there.
  explicit LineServer(const Config& config);
  ~LineServer();

  int port() const noexcept;
  std::size_t viewers() const noexcept;

  // For all viewers, at the next Service.
  void Send(std::span<const std::byte> bytes);
  // Does what can be done without waiting. Returns what viewers sent since the last call, in order
  // of its arrival. A page of another server is refused: it could send commands.
  std::vector<std::byte> Service();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_LINE_SERVER_H_
