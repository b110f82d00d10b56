#include "app/animatronic/output_thread.h"

#include <pthread.h>

#include <cmath>
#include <limits>
#include <string>
#include <system_error>

#include "app/error.h"

namespace facewire::app {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

}  // namespace

OutputThread::OutputThread(ServoOutput& output, hal::Clock& clock) noexcept
    : output_(output), clock_(clock) {
  next_.servo_count = static_cast<std::uint8_t>(output.animatronic().servos());
  next_.bus_count = static_cast<std::uint8_t>(output.animatronic().buses());
  for (std::atomic<float>& hand : hands_) hand.store(kNothing);
}

void OutputThread::Begin() {
  try {
    thread_ = std::thread([this] { Run(); });
  } catch (const std::system_error& e) {
    throw Failure(std::string("starting the servos' thread: ") + e.what());
  }
  (void)::pthread_setname_np(thread_.native_handle(), "servos");
}

void OutputThread::End() noexcept {
  if (!thread_.joinable()) return;
  ending_.store(true);
  thread_.join();
}

// Deadlines are absolute, so that ticks do not drift; after a gap there is nothing to make up.
void OutputThread::Run() noexcept {
  for (Time next = clock_.Now(); !ending_.load();) {
    Step();
    next += output_.period();
    const Time now = clock_.Now();
    if (now > next) {
      ++next_.late;
      next = now;
    }
    clock_.SleepUntil(next);
  }
  output_.Close(kCloseWithin);
}

void OutputThread::Step() noexcept {
  const Time now = clock_.Now();
  animatronic::Animatronic& animatronic = output_.animatronic();
  // Before the wishes: none of them may move anything any more.
  if (stopped_.load() != animatronic.stopped()) {
    animatronic.stopped() ? animatronic.Release() : animatronic.Stop();
  }
  if (const servo::Wishes* wishes = wishes_.Take()) animatronic.Take(*wishes, now);
  TakeHands(now);
  output_.Tick();
  ++next_.ticks;
  Watch(now);
  if (now < next_report_) return;
  next_report_ = now + kReportEvery;
  Report(now);
}

bool OutputThread::MoveByHand(std::size_t servo, float position) noexcept {
  if (servo >= output_.animatronic().servos() || !std::isfinite(position)) return false;
  hands_[servo].store(position);
  return true;
}

void OutputThread::TakeHands(Time now) noexcept {
  for (std::size_t i = 0; i < next_.servo_count; ++i) {
    const float position = hands_[i].exchange(kNothing);
    if (!std::isnan(position)) output_.animatronic().SetManual(i, position, now);
  }
}

// What must not be missed between two reports.
void OutputThread::Watch(Time now) noexcept {
  for (std::size_t i = 0; i < next_.servo_count; ++i) {
    const bus::ServoFeedback& feedback = output_.animatronic().feedback(i);
    std::optional<Time>& stranded = next_.servos[i].stranded;
    if (feedback.state != bus::ServoState::kAbsent) {
      had_torque_[i] = feedback.torque;
      stranded.reset();
    } else if (had_torque_[i] && !stranded) {
      stranded = now;
    }
  }
  for (std::size_t i = 0; i < next_.bus_count; ++i) {
    std::optional<Time>& closed = next_.buses[i].closed;
    if (output_.port(i) != PortState::kClosed) {
      closed.reset();
    } else if (!closed) {
      closed = now;
    }
  }
}

void OutputThread::Report(Time now) noexcept {
  const animatronic::Animatronic& animatronic = output_.animatronic();
  next_.at = now;
  for (std::size_t i = 0; i < next_.servo_count; ++i) {
    next_.servos[i].command = animatronic.commands().servos[i];
    next_.servos[i].feedback = animatronic.feedback(i);
  }
  next_.findings.clear();
  for (std::size_t i = 0; i < next_.bus_count; ++i) {
    const bus::BusStatus& status = animatronic.status(i);
    ServoReport::Bus& bus = next_.buses[i];
    bus.state = status.state;
    bus.fault = status.fault;
    bus.port = output_.port(i);
    bus.counters = output_.counters(i);
    bus.questions = status.questions;
    bus.lost = status.lost;
    bus.torque_lost = status.torque_lost;
    bus.serial_errors = status.serial_errors;
    for (bus::Finding finding : status.findings) {
      finding.servo = output_.servos(i)[finding.servo];
      (void)next_.findings.try_push(finding);  // beyond the capacity: the first are a beginning
    }
  }
  reports_.Put(next_);
}

const ServoReport& OutputThread::report() noexcept {
  static constexpr ServoReport kNone{};
  if (const ServoReport* fresh = reports_.Take()) seen_ = fresh;
  return seen_ == nullptr ? kNone : *seen_;
}

}  // namespace facewire::app
