#include "app/application.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "app/animatronic/servo_change.h"
#include "app/answer_text.h"
#include "app/devices.h"
#include "app/error.h"
#include "app/networks.h"
#include "app/neutral_file.h"
#include "app/status_report.h"
#include "hal/fake/fake_camera.h"
#include "hal/replay/replay_camera.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;

// The address of the recording or camera.
std::string CameraAddress(const CameraConfig& camera, bool fake) {
  if (!fake && camera.device != "replay") return camera.device;
  return camera.replay.file.empty() ? "" : "replay:" + camera.replay.file.string();
}

// The address of the line; "" for none. Mock hardware is a pseudo-terminal, with the link that the
// configuration gives or without one.
std::string LineAddress(const HostConfig& host, const ApplicationOptions& options) {
  if (options.read_only || host.line == "none") return "";
  return options.fake && !host.line.starts_with("pty:") ? "pty:" : host.line;
}

CameraOptions CameraOptionsOf(const CameraConfig& camera) {
  CameraOptions options;
  options.width_px = camera.width_px;
  options.height_px = camera.height_px;
  options.fps = camera.fps;
  options.format = camera.format;
  options.pace =
      camera.replay.pace == ReplayConfig::Pace::kFast ? hal::Pace::kFast : hal::Pace::kRealTime;
  switch (camera.replay.loop) {
    case ReplayConfig::Loop::kNone:
      options.loop = hal::LoopMode::kNone;
      break;
    case ReplayConfig::Loop::kRestart:
      options.loop = hal::LoopMode::kRestart;
      break;
    case ReplayConfig::Loop::kPingPong:
      options.loop = hal::LoopMode::kPingPong;
      break;
  }
  options.memory_bytes = static_cast<std::size_t>(camera.replay.memory_mib) << 20U;
  return options;
}

// Where an emergency stop is remembered: for good, and, when that is impossible, over a restart of
// the service (RuntimeDirectoryPreserve in the unit).
std::vector<std::string> LatchFolders(const Config& config) {
  return {config.neutral.folder.string(), config.control.socket.parent_path().string()};
}

}  // namespace

Application::Application(const ApplicationOptions& options, hal::Clock& clock, Journal& journal)
    : options_(options),
      clock_(clock),
      journal_(journal),
      config_(LoadConfig(options.config)),
      path_({.tracker = config_.tracker.tracker, .filter = config_.filter, .pose = config_.pose}),
      camera_address_(CameraAddress(config_.camera, options.fake)),
      line_address_(LineAddress(config_.host, options)),
      latch_(LatchFolders(config_)) {
  Build();
}

// In the order in which the parts lie in the block.
void Application::Build() {
  const track::Model model = config_.tracker.tracker.model;
  constexpr std::size_t kAlignment = 64;  // what rounding up each part may take
  block_bytes_ = FramePath::RequiredBytes(model) + Cast::RequiredBytes() +
                 retarget::NeutralCapture::RequiredBytes() + 3 * kAlignment;
  block_ = std::make_unique<std::byte[]>(block_bytes_);  // zeroed: every page is there from now on
  arena_.emplace(std::span(block_.get(), block_bytes_));

  std::string problems;
  Collect(problems, [&] {
    const Networks networks = LoadNetworks(config_.tracker.networks, model);
    const Result<> loaded = path_.Load(networks.files(), *arena_);
    if (loaded) return;
    const std::string line = "the networks in " + config_.tracker.networks.string() + ": ";
    if (loaded.error() == Errc::kCorrupt) throw BadInput(line + Name(loaded.error()));
    throw Failure(line + Name(loaded.error()));
  });
  Collect(problems, [&] {
    cast_.Load(config_.character, *arena_);
    BuildServos();
  });
  retarget::NeutralCaptureConfig capture;
  if (config_.neutral.auto_s > 0) {
    capture.duration = milliseconds(static_cast<int>(1000 * config_.neutral.auto_s));
  }
  if (const Result<> ok = capture_.Configure(capture, *arena_); !ok) {
    throw Failure(std::string("preparing the neutral's capture: ") + Name(ok.error()));
  }
  if (!problems.empty()) throw BadInput(problems);
}

void Application::BuildServos() {
  servo_rig_ = cast_.running().servos;
  if (config_.buses.empty() || options_.read_only) return;
  std::vector<ServoBusConfig> buses = config_.buses;
  for (ServoBusConfig& bus : buses) {
    // Mock hardware: nobody at the other end of a pseudo-terminal without a link.
    if (options_.fake && !bus.port.starts_with("pty:")) bus.port = "pty:";
  }
  try {
    output_.emplace(buses, servo_rig_, clock_);
  } catch (const BadInput& e) {
    throw BadInput(config_.character.rig.string() + ", with the buses of " +
                   options_.config.string() + ":\n" + e.what());
  }
}

bool Application::PlaysFast() const {
  return camera_address_.starts_with("replay:") &&
         config_.camera.replay.pace == ReplayConfig::Pace::kFast;
}

ServiceConfig Application::ServiceConfigOf(const Config& config) const {
  ServiceConfig service;
  service.states = config.states;
  service.filter = config.filter;
  service.min_rate_hz = config.host.min_rate_hz;
  service.describe_every = milliseconds(static_cast<int>(1000 * config.host.describe_every_s));
  service.media_time = PlaysFast();
  // Nobody at the other end of a pseudo-terminal is no fault.
  service.line_stuck_after = line_address_.starts_with("pty:")
                                 ? Duration::zero()
                                 : milliseconds(static_cast<int>(1000 * config.host.stuck_after_s));
  return service;
}

void Application::Open() {
  // First, so that a second service hears of the first one and not of a busy camera.
  const std::string no_control = OpenControl();
  // Then these, because a process that was killed may have left the servos with power. A line that
  // was asked for and cannot be had is a reason not to start: an emergency stop that does nothing
  // is worse than none.
  lines_ = OpenGpioLines(config_.gpio, options_.fake, clock_);
  PrepareStorage();
  if (camera_address_.empty()) {
    // Nothing to play: a grey picture, in which nobody is.
    blank_view_.width_px = config_.camera.width_px;
    blank_view_.height_px = config_.camera.height_px;
    blank_.assign(static_cast<std::size_t>(config_.camera.width_px) *
                      static_cast<std::size_t>(config_.camera.height_px),
                  128);
    blank_view_.planes[0] = {blank_.data(), config_.camera.width_px};
    hal::fake::FakeCameraConfig fake;
    fake.pictures = std::span(&blank_view_, 1);
    fake.fps = config_.camera.fps;
    camera_ = std::make_unique<hal::fake::FakeCamera>(fake, clock_);
  } else {
    camera_ = MakeCamera(camera_address_, CameraOptionsOf(config_.camera), clock_);
  }
  if (!line_address_.empty()) {
    port_ = MakeHostLine(line_address_, config_.host.baud);
    OpenSerialPort(*port_, line_address_, config_.host.baud);
  }
  if (output_) {
    output_->Open();
    servos_.emplace(*output_, clock_);
    servo_watch_.emplace(journal_, servo_rig_, config_.buses);
  }
  StartCamera(*camera_, camera_address_);

  line_.emplace(port_.get(), clock_, milliseconds(config_.host.write_budget_ms),
                config_.host.protocol, config_.host.baud);
  if (!line_->Open()) throw Failure(line_address_ + ": was lost while starting");
  service_.emplace(
      ServiceConfigOf(config_),
      ServiceParts{
          .camera = *camera_,
          .line = *line_,
          .clock = clock_,
          .follower = follower_,
          .capture = capture_,
          .control = &control_,
          .stop = lines_.stop.get(),
          .calibrate = lines_.calibrate.get(),
          .status_led = lines_.status_led.get(),
          .servo_power = lines_.servo_power.get(),
          .servos = servos_ ? &*servos_ : nullptr,
          .keep_neutral = [this](const retarget::Neutral& neutral) { return KeepNeutral(neutral); },
          .latch = &latch_,
          .log_answer =
              [this](const wire::Acknowledgement& answer) {
                journal_.Write(Event::kButtonPress, AnswerText(answer).data(), Name(answer.code));
              },
          .log_panel = [this](const char* text) { journal_.Write(Event::kBoardLine, text); }},
      cast_.running());
  TakeStoredNeutral();
  if (servos_) servos_->Begin();
  if (!no_control.empty()) journal_.Write(Event::kNoControl, no_control);
}

// A board whose disk is full, read-only or gone must still move a face.
void Application::PrepareStorage() {
  const std::filesystem::path& folder = config_.neutral.folder;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && ::access(folder.c_str(), W_OK | X_OK) != 0) {
    error.assign(errno, std::generic_category());
  }
  if (error) {
    storage_problem_ = folder.string() + ": " + error.message();
    journal_.Write(Event::kStorageUnwritable,
                   "neither a neutral nor an emergency stop will outlast a loss of power: " +
                       storage_problem_);
  }
  if (latch_.Engaged()) {
    journal_.Write(
        Event::kStopRemembered,
        "an emergency stop from before the start still holds; `facewire release` ends it",
        latch_.reason());
  }
}

// Why there is no control socket although there should be one; "" when all is well. A puppet that
// nobody on the board can command is still a puppet, so only another service at the same place is a
// reason not to start: two would fight over one camera and one puppet. Mock hardware leaves the
// device's own socket alone.
std::string Application::OpenControl() {
  const std::filesystem::path& socket = config_.control.socket;
  if (socket.empty() || (options_.fake && socket == ControlConfig{}.socket)) return "";
  const Result<> opened = control_.Open(socket.string());
  if (opened) return "";
  if (opened.error() == Errc::kBusy) {
    throw BadInput(socket.string() +
                   ": another facewired serves this control socket; stop that one, or give this "
                   "one another [control] socket");
  }
  const bool folder = opened.error() == Errc::kNotFound;
  return "running without the control socket " + socket.string() + ": " +
         (folder ? "its folder does not exist" : Name(opened.error()));
}

// A neutral that cannot be used must not keep a board from starting: the performer is there to give
// another one.
void Application::TakeStoredNeutral() {
  std::error_code error;
  if (std::filesystem::exists(NeutralFile(), error) || error) {
    std::string why = "cannot be used";
    try {
      if (service_->UseNeutral(LoadNeutral(NeutralFile()))) return;
      why = NeutralFile().string() + ": " + why;
    } catch (const BadInput& e) {
      why = e.what();
    }
    journal_.Write(Event::kNeutralUnusable, why + "; taking a new neutral");
  }
  if (config_.neutral.auto_s > 0) service_->TakeNeutralByItself();
}

std::string Application::KeepNeutral(const retarget::Neutral& neutral) const {
  try {
    std::filesystem::create_directories(config_.neutral.folder);
    SaveNeutral(NeutralFile(), neutral);
    journal_.Write(Event::kNeutralKept, "the performer's neutral is kept");
    return "";
  } catch (const std::exception& e) {
    journal_.Write(Event::kNeutralNotKept,
                   std::string("the neutral is kept only until the restart: ") + e.what());
    return e.what();
  }
}

// The program.
void Application::Run(Requests& requests, Duration limit) {
  supervisor_.Ready();
  journal_.Write(Event::kReady, "ready");
  began_ = clock_.Now();
  const Time media_began = service_->now();
  while (service_->Tick()) {
    observer_.Look(*service_, clock_.Now());
    if (servo_watch_) {
      servo_watch_->Look(*service_->servos(), service_->servos_powered(), clock_.Now());
    }
    RunErrands();
    if (requests.quit.load() > 0) service_->Quit();
    if (requests.quit.load() > 1) break;
    if (limit > Duration::zero() && service_->now() - media_began >= limit) service_->Quit();
    if (requests.reload.exchange(false)) (void)Reload();
  }
  supervisor_.Stopping();
  if (servos_) servos_->End();
}

// What programs on the board have asked for and the tick cannot answer.
void Application::RunErrands() {
  while (const auto errand = service_->NextErrand()) {
    if (errand->command.code == wire::CommandCode::kReload) {
      const std::string problems = Reload();
      service_->Answer(*errand,
                       problems.empty() ? wire::CommandResult::kOk : wire::CommandResult::kFailed,
                       0, problems);
      continue;
    }
    const StatusReport report{.service = *service_,
                              .line = *line_,
                              .camera_address = camera_address_,
                              .line_address = line_address_,
                              .state_folder = config_.neutral.folder.native(),
                              .storage_problem = storage_problem_,
                              .stop_problem = latch_.reason(),
                              .searching_after = observer_.searching_after(),
                              .buses = config_.buses,
                              .servos = &servo_rig_};
    service_->Answer(*errand, wire::CommandResult::kOk, 0, ToJson(report).data());
  }
}

// True: the mapper of `fresh` moves the servos that are driven. False: they have changed too much,
// and are moved as before by the channels of the new rig. Throws BadInput: which it does not have.
bool Application::UseServos(Character& fresh, const std::filesystem::path& file) const {
  if (!output_ || SameButForMapping(servo_rig_, fresh.servos)) return true;
  const std::optional<servo::Flaw> flaw = servo::FindFlaw(servo_rig_, fresh.rig);
  if (flaw) {
    throw BadInput(file.string() + ": servo \"" +
                   std::string(servo_rig_.servos[flaw->servo].name.view()) +
                   "\" follows a channel that this rig does not have, and other servos need a "
                   "restart");
  }
  (void)fresh.mapper.Configure(servo_rig_, fresh.rig);  // without a flaw
  return false;
}

// Between two ticks. Building may allocate; whatever goes wrong, the old character runs on. Answers
// with every mistake on a line of its own.
std::string Application::Reload() {
  std::string problems;
  supervisor_.Reloading(clock_.Now());
  try {
    const Config fresh = LoadConfig(options_.config);
    Character& prepared = cast_.Prepare(fresh.character);
    const bool servos_stay = UseServos(prepared, fresh.character.rig);
    if (const Result<> ok = service_->Reload(ServiceConfigOf(fresh), prepared); !ok) {
      throw BadInput(fresh.character.rig.string() + ": " + Name(ok.error()));
    }
    cast_.Switch(fresh.character);
    config_.states = fresh.states;
    config_.filter = fresh.filter;
    journal_.Write(Event::kReloaded,
                   "reloaded rig, blend, filter, rates and state times; other changes need a "
                   "restart");
    if (!servos_stay) {
      journal_.Write(Event::kReloadProblem,
                     "the rig's servos have changed in more than what moves them (from, offset, "
                     "map): they go on as before until a restart");
    }
  } catch (const std::exception& e) {
    problems = e.what();
    journal_.Write(Event::kReloadProblem, "not reloaded, running on as before:\n" + problems);
  }
  supervisor_.Ready();
  return problems;
}

std::string Application::Summary() const {
  const std::filesystem::path& socket = config_.control.socket;
  std::string text = "ok\n";
  text += "camera   " + (camera_address_.empty() ? "a blank picture" : camera_address_) + "\n";
  text += "networks " + config_.tracker.networks.string() + "\n";
  text += cast_.Summary();
  text += "gpio     " + GpioSummary(config_.gpio) + "\n";
  text += "servos   " + ServoSummary() + "\n";
  text += "host     " + (line_address_.empty() ? "none" : line_address_) +
          (config_.host.protocol == HostProtocol::kOsc ? ", OSC in SLIP\n" : "\n");
  text += "control  " + (socket.empty() ? "none" : socket.string()) + "\n";
  return text;
}

std::string Application::ServoSummary() const {
  if (servo_rig_.servos.empty()) return "none";
  const std::string count = std::to_string(servo_rig_.servos.size());
  if (config_.buses.empty()) return count + ", and no [[bus]] that drives them";
  std::string text = count;
  for (const ServoBusConfig& bus : config_.buses) {
    text += "\nbus      " + bus.name + ": " + Name(bus.kind) + ", " + bus.port + ", " +
            std::to_string(bus.rate_hz) + " Hz:";
    for (const servo::Servo& servo : servo_rig_.servos) {
      if (servo.bus.view() != bus.name) continue;
      text += " " + std::string(servo.name.view()) + " (" + std::to_string(servo.id) + ")";
    }
  }
  return text;
}

MemoryReport Application::Memory() const {
  MemoryReport report;
  report.parts.push_back({"tracker", FramePath::RequiredBytes(config_.tracker.tracker.model),
                          "networks, their weights and buffers"});
  cast_.AddTo(report);
  report.parts.push_back({"neutral capture", retarget::NeutralCapture::RequiredBytes(),
                          "frames of a performer's face at rest"});
  report.parts.push_back(
      {"service", sizeof(Application), "states, limits, rigs, frames of the line, counters"});
  report.parts.push_back(
      {"servo buses", output_ ? output_->bytes() : 0, "drivers, ports' buffers and their reports"});
  std::size_t footage = static_cast<std::size_t>(config_.camera.replay.memory_mib) << 20U;
  if (const auto* replay = dynamic_cast<const hal::replay::ReplayCamera*>(camera_.get())) {
    footage = replay->info().block_bytes;
  } else if (!camera_address_.starts_with("replay:")) {
    footage = 0;
  }
  report.parts.push_back({"footage", footage, "a recording decoded ahead (mock hardware only)"});
  return report;
}

RunReport Application::Report() const {
  const ServiceStats& stats = service_->stats();
  const HostLineCounters& line = line_->counters();
  RunReport report;
  report.seconds = static_cast<double>(Seconds(clock_.Now() - began_));
  report.ticks = stats.ticks;
  report.frames = stats.frames;
  report.fps = report.seconds > 0 ? static_cast<double>(stats.frames) / report.seconds : 0;
  report.frames_dropped = stats.frames_dropped;
  report.frames_damaged = stats.frames_damaged;
  report.faces = stats.faces;
  report.rejected = stats.rejected;
  report.losses = stats.losses;
  report.blinks = stats.blinks.count();
  report.latency_p50_us = stats.latency.Quantile(0.5).count();
  report.latency_p99_us = stats.latency.Quantile(0.99).count();
  report.camera_restarts = stats.camera_restarts;
  report.poses_sent = line.poses;
  report.poses_dropped = line.poses_dropped;
  report.line_errors = line.write_errors;
  report.line_bytes = line.bytes;
  report.line_losses = line.hang_ups;
  report.line_reopens = line.opens > 0 ? line.opens - 1 : 0;
  report.resident_bytes = ResidentBytes();
  report.footage_bytes = Memory().parts.back().bytes;
  return report;
}

}  // namespace facewire::app
