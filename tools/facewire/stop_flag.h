#ifndef FACEWIRE_TOOLS_FACEWIRE_STOP_FLAG_H_
#define FACEWIRE_TOOLS_FACEWIRE_STOP_FLAG_H_

#include <csignal>

namespace facewire::tools {

// For a command that a person ends with Ctrl-C and that then finishes its work, such as a recording
// from a live camera. While one exists, SIGINT and SIGTERM only set it. One at a time in a process.
class StopFlag {
 public:
  StopFlag() noexcept {
    raised = 0;
    for (int i = 0; i < 2; ++i) before_[i] = std::signal(kSignals[i], [](int) { raised = 1; });
  }
  ~StopFlag() {
    for (int i = 0; i < 2; ++i) std::signal(kSignals[i], before_[i]);
  }
  StopFlag(const StopFlag&) = delete;
  StopFlag& operator=(const StopFlag&) = delete;

  bool Raised() const noexcept { return raised != 0; }

 private:
  static constexpr int kSignals[2] = {SIGINT, SIGTERM};
  static inline volatile std::sig_atomic_t raised = 0;
  void (*before_[2])(int) = {};
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_STOP_FLAG_H_
