#ifndef FACEWIRE_APP_APPLICATION_H_
#define FACEWIRE_APP_APPLICATION_H_

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/animatronic/output_thread.h"
#include "app/animatronic/servo_output.h"
#include "app/animatronic/servo_watch.h"
#include "app/cast.h"
#include "app/config.h"
#include "app/control.h"
#include "app/follower.h"
#include "app/gpio_lines.h"
#include "app/host_line.h"
#include "app/journal.h"
#include "app/observer.h"
#include "app/report.h"
#include "app/service.h"
#include "app/stop_latch.h"
#include "app/supervisor.h"
#include "core/base/arena.h"
#include "core/frame_path/frame_path.h"
#include "core/retarget/neutral_capture.h"
#include "core/servo/servo_rig.h"
#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/serial_port.h"

namespace facewire::app {

struct ApplicationOptions {
  std::filesystem::path config;
  bool fake = false;       // mock hardware: the configured recording and a pseudo-terminal
  bool read_only = false;  // tracks, but opens no line to a host
};

// What signals ask for. Set by their handlers, read between ticks.
struct Requests {
  std::atomic<int> quit{0};  // the second one does not wait for neutral
  std::atomic<bool> reload{false};
};

// facewired: everything that the service is made of, built once, in order, on one block of memory.
class Application {
 public:
  // Reads and checks the configuration, the rig, the profile and the networks, and builds every
  // stage. Touches no device. Throws BadInput with every problem on a line of its own; Failure.
  // All but the options is borrowed.
  Application(const ApplicationOptions& options, hal::Clock& clock, Journal& journal);
  Application(const Application&) = delete;
  Application& operator=(const Application&) = delete;

  // What was read, in a few lines for a person.
  std::string Summary() const;
  // Memory part by part; the footage block only once it is there.
  MemoryReport Memory() const;

  // Opens the devices. Throws BadInput (not there, busy), Failure.
  void Open();
  // Runs until the service has finished, or for `limit` if that is above zero. Open comes first.
  void Run(Requests& requests, Duration limit);
  RunReport Report() const;

  // The service, for tests; Open comes first.
  Service& service() { return *service_; }

 private:
  void Build();
  ServiceConfig ServiceConfigOf(const Config& config) const;
  bool PlaysFast() const;
  std::filesystem::path NeutralFile() const { return config_.neutral.folder / "performer.neutral"; }
  void BuildServos();
  std::string ServoSummary() const;
  void TakeStoredNeutral();
  std::string OpenControl();
  std::string KeepNeutral(const retarget::Neutral& neutral) const;
  void PrepareStorage();
  std::string Reload();
  bool UseServos(Character& fresh, const std::filesystem::path& file) const;
  void RunErrands();

  ApplicationOptions options_;
  hal::Clock& clock_;
  Journal& journal_;
  Config config_;

  std::size_t block_bytes_ = 0;
  std::unique_ptr<std::byte[]> block_;  // networks, cast, capture: in this order
  std::optional<Arena> arena_;
  FramePath path_;
  Cast cast_;
  retarget::NeutralCapture capture_;
  FramePathFollower follower_{path_};

  std::string camera_address_;
  std::unique_ptr<hal::Camera> camera_;
  std::vector<std::uint8_t> blank_;  // the picture of the built-in fake camera
  ImageView blank_view_;
  std::string line_address_;  // empty: no line
  std::unique_ptr<hal::SerialPort> port_;
  std::optional<HostLine> line_;
  Control control_;
  GpioLines lines_;
  servo::ServoRig servo_rig_;  // of the servos that are driven; a reload changes nothing about it
  std::optional<ServoOutput> output_;  // none without a [[bus]]
  std::optional<OutputThread> servos_;
  std::optional<ServoWatch> servo_watch_;
  std::string storage_problem_;  // why the state folder takes nothing; "": it does
  StopLatch latch_;
  std::optional<Service> service_;

  Supervisor supervisor_;
  Observer observer_{journal_, supervisor_, latch_};
  Time began_{};
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_APPLICATION_H_
