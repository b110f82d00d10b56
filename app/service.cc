#include "app/service.h"

#include <algorithm>
#include <limits>

#include "core/wire/pose.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;

// A capture time further from the present than this is of another clock.
constexpr Duration kOldestPicture = milliseconds(500);
// Far longer than the opening of any port.
constexpr Duration kServosHang = std::chrono::seconds(10);

std::uint32_t Low32(std::uint64_t count) noexcept { return static_cast<std::uint32_t>(count); }

std::uint32_t Microseconds(Duration d) noexcept {
  return static_cast<std::uint32_t>(
      std::clamp<std::int64_t>(d.count(), 0, std::numeric_limits<std::uint32_t>::max()));
}

}  // namespace

Service::Service(const ServiceConfig& config, const ServiceParts& parts,
                 Character& character) noexcept
    : config_(config),
      parts_(parts),
      character_(&character),
      calibration_(parts.capture),
      panel_({.stop = parts.stop,
              .calibrate = parts.calibrate,
              .status_led = parts.status_led,
              .servo_power = parts.servo_power},
             parts.log_panel),
      camera_(parts.camera, parts.clock, stats_) {
  started_ = parts_.clock.Now();
  deadline_ = started_ + period();
  now_ = config_.media_time ? Time{} : started_;
  next_status_ = status_at_ = next_description_ = now_;
  if (parts_.servos != nullptr) servo_power_.emplace(parts_.servos->contract());
  (void)Reload(config, character);  // passed its checks, and there is no neutral yet
  stop_remembered_ = stop_kept_ = parts_.latch != nullptr && parts_.latch->Engaged();
}

Result<> Service::Reload(const ServiceConfig& config, Character& character) noexcept {
  if (neutral_) {
    if (const Result<> ok = character.retargeter.SetNeutral(*neutral_); !ok) return ok;
  }
  if (const Result<> ok = motion_.Configure(character.rig, config.states, now_); !ok) return ok;
  config_ = config;
  character_ = &character;
  parts_.follower.Use(character, config.filter);
  parts_.line.SetRig(character.rig, character.rig_id);
  blink_left_ = character.rig.FindChannel("eyeBlinkLeft");
  blink_right_ = character.rig.FindChannel("eyeBlinkRight");
  return {};
}

Result<> Service::UseNeutral(const retarget::Neutral& neutral, NeutralKind kind) noexcept {
  const Result<> used = character_->retargeter.SetNeutral(neutral);
  if (used) {
    neutral_ = neutral;
    neutral_kind_ = kind;
  }
  return used;
}

// The whole service.
bool Service::Tick() noexcept {
  state::Inputs in;
  in.sight = Look();
  in.now = now_;
  in.line_gone = !parts_.line.connected();
  ReadCommands(in);
  in.rest = rest_;
  in.quit = quit_;
  const ServiceState before = motion_.state();
  const MotionOutput out = motion_.Update(in, wish_);
  if (before == ServiceState::kTracking && out.state == ServiceState::kHolding) ++stats_.losses;
  Send(out);
  if (out.state == ServiceState::kStopped) RememberStop();
  ++stats_.ticks;
  return !out.finished;
}

// Waits for a picture until the tick is due, and follows it.
state::Sight Service::Look() noexcept {
  const bool ran = camera_.running();
  const Result<Frame> frame = camera_.Wait(deadline_, silence());
  pictured_ = frame.has_value();
  if (pictured_) {
    const state::Sight sight = See(*frame);
    camera_.Release(*frame);
    return sight;
  }
  if (ran && !camera_.running()) parts_.follower.Forget();
  if (!ran && !camera_.running() && !config_.media_time) parts_.clock.SleepUntil(deadline_);
  MissPicture();
  return state::Sight::kSilent;
}

state::Sight Service::See(const Frame& frame) noexcept {
  acquired_ = camera_.last_picture();
  deadline_ = acquired_ + period();
  now_ = config_.media_time ? frame.captured
                            : std::clamp(frame.captured, acquired_ - kOldestPicture, acquired_);
  const Result<Followed> followed = parts_.follower.Follow(frame);
  if (followed) {
    ++stats_.faces;
    wish_ = followed->rig;
  } else if (followed.error() == Errc::kRejected) {
    ++stats_.rejected;
  }
  wish_.seq = frame.seq;
  wish_.captured = now_;
  if (calibration_.Update(now_, followed ? &followed->face : nullptr, outcome_)) EndCalibration();
  OfferLandmarks(frame, followed);
  return SightOf(followed);
}

// Stamped as the pose of this tick.
void Service::OfferLandmarks(const Frame& frame, const Result<Followed>& followed) noexcept {
  if (!parts_.line.landmarks_asked()) return;
  Landmarks seen = followed ? followed->landmarks : Landmarks{};
  seen.seq = frame.seq;
  seen.captured = now_;
  seen.width_px = frame.image.width_px;
  seen.height_px = frame.image.height_px;
  parts_.line.OfferLandmarks(seen);
}

void Service::MissPicture() noexcept {
  ++stats_.silent_ticks;
  const Time clock = parts_.clock.Now();
  now_ = config_.media_time ? now_ + period() : std::max(now_, clock);
  wish_.captured = now_;
  if (calibration_.Wait(now_, outcome_)) EndCalibration();
  deadline_ += period();
  if (deadline_ < clock) deadline_ = clock + period();
  if (camera_.ended()) quit_ = true;
}

const char* Service::Ailment() const noexcept {
  const Time clock = parts_.clock.Now();
  if (camera_.Stuck(silence())) return "the camera opens but sends no fresh pictures";
  if (config_.line_stuck_after > Duration::zero() &&
      parts_.line.TakesNothingFor() > config_.line_stuck_after) {
    return "the line is open but takes no bytes";
  }
  if (servo_report_ != nullptr && clock - std::max(servo_report_->at, started_) > kServosHang) {
    return "the servos' thread hangs";
  }
  return "";
}

const char* Service::reason() const noexcept {
  switch (motion_.state()) {
    case ServiceState::kStopped:
      return stopped_by_;
    case ServiceState::kFault:
      if (!parts_.line.connected()) return "the line to the host is gone";
      return camera() == WatchedCamera::Health::kGone ? "the camera is gone"
                                                      : "the camera is silent";
    default:
      if (quit_) return camera_.ended() ? "the recording is over" : "asked to end";
      return rest_ ? "asked to rest" : "";
  }
}

void Service::ReadCommands(state::Inputs& in) noexcept {
  in.stop = panel_.ReadStop(now_) || stop_remembered_;
  if (in.stop) {
    stopped_by_ = panel_.stop_open() ? "by the stop line" : "remembered from before the start";
  }
  stop_remembered_ = false;
  while (const auto command = parts_.line.NextCommand()) Obey({.command = *command}, in);
  if (parts_.control != nullptr) {
    parts_.control->Poll();
    while (const auto request = parts_.control->Next()) Obey(*request, in);
  }
  ReadButton(in);
}

void Service::ReadButton(state::Inputs& in) noexcept {
  const Button::Press press = panel_.ReadButton(now_);
  if (press == Button::Press::kNone) return;
  const auto code = press == Button::Press::kShort ? wire::CommandCode::kCalibrateNeutral
                                                   : wire::CommandCode::kRelease;
  Obey({.command = {.code = code}, .asker = kButton}, in);
}

void Service::Obey(const Request& request, state::Inputs& in) noexcept {
  ++stats_.commands;
  wire::CommandResult result = wire::CommandResult::kOk;
  std::string_view why;
  switch (request.command.code) {
    case wire::CommandCode::kPing:
      break;
    case wire::CommandCode::kDescribeRig:
      parts_.line.Describe();
      break;
    case wire::CommandCode::kCalibrateNeutral:
      if (motion_.state() != ServiceState::kTracking) {
        result = wire::CommandResult::kNoFace;
      } else if (calibration_.Begin(request, now_)) {
        return;  // answered when it is done
      } else {
        result = wire::CommandResult::kRefused;
      }
      break;
    case wire::CommandCode::kRest:
      rest_ = true;
      break;
    case wire::CommandCode::kStop:
      in.stop = true;
      in.release = false;
      stopped_by_ = "by a command";
      if (stop_) break;  // all of them are one
      stop_ = request;
      return;  // answered when nothing moves any more and the latch has it
    case wire::CommandCode::kRelease:
      result = Release(in, why);
      break;
    case wire::CommandCode::kReport:
    case wire::CommandCode::kReload:
      // Texts are for programs on the board: a line is for poses.
      if (request.asker >= kFirstClient && errands_.try_push(request)) return;
      result = wire::CommandResult::kRefused;
      break;
    case wire::CommandCode::kBlendProfile: {
      const float part = request.command.value;
      if (part >= 0 && part <= 1 && character_->retargeter.has_personal()) {
        character_->retargeter.SetBlend(part);
      } else {
        result = wire::CommandResult::kRefused;
      }
      break;
    }
    case wire::CommandCode::kMoveServo:
      if (parts_.servos == nullptr || motion_.state() == ServiceState::kStopped ||
          !parts_.servos->MoveByHand(request.command.item, request.command.value)) {
        result = wire::CommandResult::kRefused;
      }
      break;
    case wire::CommandCode::kLandmarks:
      if (request.asker != kHostLine || !parts_.line.AskLandmarks(request.command.value)) {
        result = wire::CommandResult::kRefused;
      }
      break;
    default:
      result = wire::CommandResult::kUnknown;
  }
  Answer(request, result, 0, why);
}

// A stop that could come back by itself, after a crash or at the next boot, is not released.
wire::CommandResult Service::Release(state::Inputs& in, std::string_view& why) noexcept {
  if (panel_.stop_open()) return wire::CommandResult::kRefused;
  if (parts_.latch != nullptr && stop_kept_ && !parts_.latch->Release()) {
    why = parts_.latch->reason();
    return wire::CommandResult::kFailed;
  }
  stop_kept_ = false;
  in.release = true;
  rest_ = false;
  return wire::CommandResult::kOk;
}

// After the host has heard of the stop: writing may take its time, nothing moves. A command that
// stops again has it tried again.
void Service::RememberStop() noexcept {
  bool kept = true;
  if (parts_.latch != nullptr && (!stop_kept_ || stop_)) kept = parts_.latch->Engage();
  stop_kept_ = true;
  if (!stop_) return;
  Answer(*stop_, kept ? wire::CommandResult::kOk : wire::CommandResult::kNotKept, 0,
         kept ? std::string_view() : parts_.latch->reason());
  stop_.reset();
}

std::optional<Request> Service::NextErrand() noexcept {
  if (errands_.empty()) return std::nullopt;
  const Request first = errands_[0];
  std::ranges::copy(errands_.span().subspan(1), errands_.begin());
  (void)errands_.try_resize(errands_.size() - 1);
  return first;
}

void Service::Answer(const Request& request, wire::CommandResult result, float measure,
                     std::string_view text) noexcept {
  const wire::Acknowledgement answer{.id = request.command.id,
                                     .code = request.command.code,
                                     .result = result,
                                     .now = parts_.clock.Now(),
                                     .measure = measure};
  if (request.asker == kHostLine) {
    parts_.line.Acknowledge(answer);
  } else if (request.asker == kButton) {
    if (parts_.log_answer) parts_.log_answer(answer);
  } else if (parts_.control != nullptr) {
    if (!text.empty()) parts_.control->Say(request.asker, request.command.id, text);
    parts_.control->Answer(request.asker, answer);
  }
}

void Service::EndCalibration() noexcept {
  std::string why;
  if (outcome_.taken) {
    // What nobody asked for is provisional and not kept.
    if (!UseNeutral(outcome_.neutral, NeutralKind::kProvisional)) {
      outcome_.result = wire::CommandResult::kFailed;
    } else if (outcome_.request && parts_.keep_neutral) {
      why = parts_.keep_neutral(outcome_.neutral);
      neutral_kind_ = why.empty() ? NeutralKind::kKept : NeutralKind::kNotKept;
      if (!why.empty()) outcome_.result = wire::CommandResult::kNotKept;
    }
  }
  if (outcome_.request) Answer(*outcome_.request, outcome_.result, outcome_.measure, why);
}

// The time for the host: in media time, how long the tick has taken is added to the picture's time.
Time Service::TimeOnLine() noexcept {
  const Time clock = parts_.clock.Now();
  if (!config_.media_time) return clock;
  return pictured_ ? now_ + (clock - acquired_) : now_;
}

// False when the servos on the buses must not have power. Without torque no wish is handed over:
// the servos' own contract takes its course.
bool Service::MoveServos(const MotionOutput& out) noexcept {
  if (parts_.servos == nullptr) return true;
  parts_.servos->SetStopped(out.state == ServiceState::kStopped);
  if (out.torque) parts_.servos->Hand(character_->mapper.Map(out.pose));
  servo_report_ = &parts_.servos->report();
  return servo_power_->Allowed(*servo_report_, parts_.clock.Now());
}

void Service::Send(const MotionOutput& out) noexcept {
  const bool servos_well = MoveServos(out);
  if (config_.describe_every > Duration::zero() && now_ >= next_description_) {
    next_description_ = now_ + config_.describe_every;
    parts_.line.Describe();
  }
  const bool status_due = StatusDue();
  const wire::Pose pose =
      wire::MakePose(character_->rig, character_->rig_id, out.pose, out.state, TimeOnLine());
  const bool taken = parts_.line.Send(pose, status_due ? &status_ : nullptr);
  panel_.Show({.now = now_,
               .state = out.state,
               .torque = out.torque,
               .pose_taken = taken || (parts_.servos != nullptr && !parts_.line.exists()),
               .servos_well = servos_well,
               .calibrating = calibration_.requested(),
               .ending = out.finished || *Ailment() != '\0'});
  if (pictured_) {
    const Duration latency = TimeOnLine() - now_;
    stats_.latency.Add(latency);
    recent_.Add(latency);
  }
  if (blink_left_ && blink_right_ && out.state == ServiceState::kTracking) {
    stats_.blinks.Update(std::max(out.pose.values[*blink_left_], out.pose.values[*blink_right_]));
  }
}

bool Service::StatusDue() noexcept {
  if (now_ < next_status_) return false;
  const float seconds = Seconds(now_ - status_at_);
  const auto fresh = static_cast<float>(stats_.frames - frames_at_status_);
  const HostLineCounters& line = parts_.line.counters();
  status_.rig_id = character_->rig_id;
  status_.state = motion_.state();
  status_.now = TimeOnLine();
  status_.uptime_s = Low32(static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::seconds>(parts_.clock.Now() - started_).count()));
  status_.centi_fps =
      seconds > 0 ? static_cast<std::uint16_t>(std::min(100 * fresh / seconds, 65535.0F)) : 0;
  status_.frames = Low32(stats_.frames);
  status_.dropped = Low32(stats_.frames_dropped);
  status_.losses = Low32(stats_.losses);
  status_.link_errors = Low32(parts_.line.received().Damaged() + line.write_errors);
  status_.latency_p50_us = Microseconds(recent_.Quantile(0.5));
  status_.latency_p99_us = Microseconds(recent_.Quantile(0.99));
  recent_.Clear();
  frames_at_status_ = stats_.frames;
  status_at_ = now_;
  next_status_ = now_ + config_.status_every;
  return true;
}

}  // namespace facewire::app
