#include "tools/facewire/monitor_session.h"

#include <array>
#include <chrono>
#include <utility>
#include <variant>

#include "app/error.h"

namespace facewire::tools {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kReadFor(20);      // so often a signal and the clock are looked at
constexpr milliseconds kScreenEvery(50);  // 20 a second: smooth, and cheap over ssh
constexpr milliseconds kPlainEvery(1000);

}  // namespace

MonitorSession::MonitorSession(std::string port_name, hal::SerialPort& port, hal::Clock& clock,
                               MonitorDisplay display, MonitorRecorder* recorder)
    : port_(port), clock_(clock), display_(std::move(display)), recorder_(recorder) {
  model_.port = std::move(port_name);
}

MonitorEnd MonitorSession::Run(const MonitorLimits& limits, const std::function<bool()>& stop) {
  const Time began = clock_.Now();
  next_show_ =
      began + (display_.kind == MonitorDisplay::Kind::kPlain ? kPlainEvery : milliseconds(0));
  std::array<std::byte, 4096> buffer;
  for (;;) {
    const Time now = clock_.Now();
    model_.elapsed_s = static_cast<double>((now - began).count()) * 1e-6;
    if (stop()) return MonitorEnd::kInterrupted;
    if (limits.seconds && model_.elapsed_s >= *limits.seconds) return MonitorEnd::kTime;
    if (limits.may_write && !model_.RigKnown()) question_.AskIfDue(now, port_);
    Show(now);
    const auto read = port_.Read(buffer, kReadFor);
    if (read) {
      if (Take(std::span(buffer).first(*read), limits.frames)) return MonitorEnd::kFrames;
    } else if (read.error() == Errc::kEnd) {
      return MonitorEnd::kEndOfFile;
    } else if (read.error() == Errc::kDisconnected) {
      return MonitorEnd::kClosed;
    } else if (read.error() != Errc::kTimeout) {
      throw app::Failure("reading " + model_.port + ": " + Name(read.error()));
    }
  }
}

bool MonitorSession::Take(std::span<const std::byte> bytes,
                          std::optional<std::uint64_t> max_poses) {
  model_.bytes += bytes.size();
  const std::span<const std::byte> read = bytes;
  bool done = false;
  while (!done) {
    const auto received = decoder_.Next(bytes);
    if (received) Use(received->message);
    if (!received && received.error() == Errc::kNotReady) break;
    done = max_poses && model_.poses >= *max_poses;
  }
  model_.link = decoder_.stats();
  if (osc_.Notices(read, model_.link.frames)) model_.note = kSpeaksOsc;
  return done;
}

void MonitorSession::Use(const wire::Message& message) {
  if (model_.rig.Add(message)) return;
  if (const auto* pose = std::get_if<wire::Pose>(&message)) {
    model_.pose = *pose;
    model_.state = pose->state;
    ++model_.poses;
    model_.rate.Add(pose->captured);
    model_.ages.Add(pose->age_us);
    if (recorder_ != nullptr) recorder_->Add(*pose, model_.rig);
  } else if (const auto* status = std::get_if<wire::Status>(&message)) {
    model_.status = *status;
    model_.state = status->state;
  } else if (const auto* answer = std::get_if<wire::Acknowledgement>(&message)) {
    const bool ok = answer->result == wire::CommandResult::kOk;
    model_.note =
        ok ? ""
           : std::string("the device answers ") + Name(answer->code) + ": " + Name(answer->result);
  }
}

void MonitorSession::Show(Time now) {
  if (display_.kind == MonitorDisplay::Kind::kNone || now < next_show_) return;
  if (display_.kind == MonitorDisplay::Kind::kPlain) {
    next_show_ += kPlainEvery;
    display_.write(PlainLine(model_) + "\n");
    return;
  }
  next_show_ = now + kScreenEvery;
  // Home, then each line over the old one with the rest of it cleared, in one write: nothing
  // flickers. The last column stays empty: a cursor that waits behind it would clear the last
  // character.
  ScreenSize size = display_.size();
  --size.columns;
  std::string out = "\x1b[H";
  for (const char c : DrawScreen(model_, size, display_.style)) {
    out += c == '\n' ? "\x1b[K\r\n" : std::string(1, c);
  }
  display_.write(out + "\x1b[K\x1b[J");
}

}  // namespace facewire::tools
