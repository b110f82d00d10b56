#ifndef FACEWIRE_TOOLS_FACEWIRE_OTHER_PROTOCOL_H_
#define FACEWIRE_TOOLS_FACEWIRE_OTHER_PROTOCOL_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace facewire::tools {

inline constexpr const char* kSpeaksOsc =
    "this line speaks OSC; for this program set [host] protocol = \"native\" in the device's "
    "facewire.toml";

// Notices that a line speaks OSC instead of the native protocol.
class OscSpotter {
 public:
  // What was read, and how many sound frames of the native protocol there have been. True once:
  // when there were none, and beginnings of OSC bundles were seen.
  bool Notices(std::span<const std::byte> bytes, std::uint64_t sound_frames) {
    constexpr std::string_view kBundle("\xC0#bundle\0", 9);
    if (done_ || sound_frames > 0) {
      done_ = true;
      return false;
    }
    for (const std::byte byte : bytes) {
      const char c = static_cast<char>(byte);
      matched_ = c == kBundle[matched_] ? matched_ + 1 : c == kBundle[0] ? 1 : 0;
      if (matched_ < kBundle.size()) continue;
      matched_ = 0;
      done_ = ++bundles_ == kEnough;
      if (done_) return true;
    }
    return false;
  }

 private:
  static constexpr int kEnough = 3;  // one may be anything, even text

  std::size_t matched_ = 0;
  int bundles_ = 0;
  bool done_ = false;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_OTHER_PROTOCOL_H_
