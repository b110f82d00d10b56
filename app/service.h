#ifndef FACEWIRE_APP_SERVICE_H_
#define FACEWIRE_APP_SERVICE_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "app/animatronic/output_thread.h"
#include "app/animatronic/servo_power.h"
#include "app/calibration.h"
#include "app/character.h"
#include "app/control.h"
#include "app/follower.h"
#include "app/host_line.h"
#include "app/panel.h"
#include "app/request.h"
#include "app/service_stats.h"
#include "app/stop_latch.h"
#include "app/watched_camera.h"
#include "core/base/inline_vector.h"
#include "core/frame_path/motion.h"
#include "core/retarget/neutral.h"
#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/gpio.h"

namespace facewire::app {

struct ServiceConfig {
  state::StateConfig states;
  filter::FilterConfig filter;
  int min_rate_hz = 20;                               // ticks a second without pictures
  Duration describe_every = std::chrono::seconds(5);  // 0: on request only
  Duration status_every = std::chrono::seconds(1);
  Duration line_stuck_after = std::chrono::seconds(10);  // takes nothing for so long; 0: never
  // The camera is a recording played as fast as possible: its frames' times are the time, and
  // nothing waits.
  bool media_time = false;
};

// What the service works with; all borrowed.
struct ServiceParts {
  hal::Camera& camera;  // started
  HostLine& line;       // opened, if it can be
  hal::Clock& clock;
  Follower& follower;
  retarget::NeutralCapture& capture;  // configured
  Control* control = nullptr;         // opened; null: none
  // The board's lines, as in PanelLines. The button: short calibrates, long releases an emergency
  // stop or a rest.
  hal::GpioInput* stop = nullptr;
  hal::GpioInput* calibrate = nullptr;
  hal::GpioOutput* status_led = nullptr;
  hal::GpioOutput* servo_power = nullptr;
  // Moves the servos by the character's mapper; null: there is no servo bus.
  OutputThread* servos = nullptr;
  // Keeps a neutral that a command took, across boots. Why it could not be kept; "" when it is.
  std::function<std::string(const retarget::Neutral&)> keep_neutral = {};
  // Remembers an emergency stop across crashes and boots; null: none does.
  StopLatch* latch = nullptr;
  // Hears what became of a press of the button, which has nobody else to tell.
  std::function<void(const wire::Acknowledgement&)> log_answer = {};
  // As Panel's.
  std::function<void(const char*)> log_panel = {};
};

// The running service: one thread, one tick after the other. A tick is a picture when there is one
// in time, else silence; either way the host gets a pose. Allocates nothing after construction, but
// where a broken device is opened again, or a commanded neutral or an emergency stop is stored.
class Service {
 public:
  // The performer's face at rest, and what became of it.
  enum class NeutralKind : std::uint8_t { kNone, kProvisional, kNotKept, kKept };
  // Runs `character` from its neutral pose. The character must have passed its checks.
  Service(const ServiceConfig& config, const ServiceParts& parts, Character& character) noexcept;

  // The performer's neutral that was kept. Errors as Retargeter::SetNeutral.
  Result<> UseNeutral(const retarget::Neutral& neutral,
                      NeutralKind kind = NeutralKind::kKept) noexcept;
  // Takes one by itself from the first calm seconds of a face.
  void TakeNeutralByItself() noexcept { calibration_.BeginByItself(); }

  // Between ticks: goes on with another character and other settings, from where the channels are
  // by way of neutral. Errors as Motion::Configure and Retargeter::SetNeutral; nothing is changed
  // then.
  Result<> Reload(const ServiceConfig& config, Character& character) noexcept;

  // Eases to neutral; Tick answers false when it is there.
  void Quit() noexcept { quit_ = true; }

  // False: finished.
  bool Tick() noexcept;

  // What only a restart of the process might still help; "" when nothing is wrong in that way. The
  // camera opens, but no fresh picture has come for three times its time-out although it was
  // restarted; the line is open, but has taken no byte for too long; or the servos' thread is not
  // heard of. (A camera or a line that is unplugged is known, and tried again.)
  const char* Ailment() const noexcept;
  // Why the state is what it is, where the state alone does not say; "" else.
  const char* reason() const noexcept;
  WatchedCamera::Health camera() const noexcept { return camera_.health(silence()); }
  NeutralKind neutral_kind() const noexcept { return neutral_kind_; }

  // The next command that this tick leaves to the service's owner, who answers it: report, reload.
  std::optional<Request> NextErrand() noexcept;
  // `text` goes before the answer, to a client of the control socket.
  void Answer(const Request& request, wire::CommandResult result, float measure = 0,
              std::string_view text = {}) noexcept;

  Time now() const noexcept { return now_; }
  ServiceState state() const noexcept { return motion_.state(); }
  const ServiceStats& stats() const noexcept { return stats_; }
  // Of the last tick; null: there is no servo bus.
  const ServoReport* servos() const noexcept { return servo_report_; }
  // False while the board's line keeps the servos without power.
  bool servos_powered() const noexcept { return panel_.servos_powered(); }
  // Of the last second that a status was made for.
  const wire::Status& status() const noexcept { return status_; }

 private:
  state::Sight Look() noexcept;
  state::Sight See(const Frame& frame) noexcept;
  void MissPicture() noexcept;
  void ReadCommands(state::Inputs& in) noexcept;
  void ReadButton(state::Inputs& in) noexcept;
  void Obey(const Request& request, state::Inputs& in) noexcept;
  wire::CommandResult Release(state::Inputs& in, std::string_view& why) noexcept;
  void RememberStop() noexcept;
  void EndCalibration() noexcept;
  void OfferLandmarks(const Frame& frame, const Result<Followed>& followed) noexcept;
  void Send(const MotionOutput& out) noexcept;
  bool MoveServos(const MotionOutput& out) noexcept;
  bool StatusDue() noexcept;
  Duration silence() const noexcept { return config_.states.camera_timeout; }
  Duration period() const noexcept { return Duration(1'000'000 / config_.min_rate_hz); }
  Time TimeOnLine() noexcept;

  ServiceConfig config_;
  ServiceParts parts_;
  Character* character_;
  Motion motion_;
  Calibration calibration_;
  Calibration::Outcome outcome_;
  std::optional<retarget::Neutral> neutral_;
  NeutralKind neutral_kind_ = NeutralKind::kNone;

  Time acquired_{};        // the tick's picture, by the clock
  Time deadline_{};        // of the next tick, by the clock: absolute, so ticks do not drift
  Time now_{};             // of the tick
  bool pictured_ = false;  // this tick has a picture
  RigPose wish_;           // of this tick

  bool quit_ = false;
  bool rest_ = false;
  Panel panel_;
  std::optional<ServoPower> servo_power_;
  const ServoReport* servo_report_ = nullptr;
  bool stop_remembered_ = false;  // from before the start; counts for the first tick
  bool stop_kept_ = false;        // the latch was asked to remember the present stop
  std::optional<Request> stop_;   // is answered when the latch has it
  const char* stopped_by_ = "";
  InlineVector<Request, 8> errands_;
  std::optional<std::size_t> blink_left_, blink_right_;

  Time started_{};
  Time next_description_{};
  Time next_status_{};
  std::uint64_t frames_at_status_ = 0;
  Time status_at_{};
  LatencyHistogram recent_;
  wire::Status status_;
  ServiceStats stats_;
  WatchedCamera camera_;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_SERVICE_H_
