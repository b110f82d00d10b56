#ifndef FACEWIRE_APP_HOST_LINE_H_
#define FACEWIRE_APP_HOST_LINE_H_

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "app/backoff.h"
#include "app/host_protocol.h"
#include "app/landmark_feed.h"
#include "app/speech.h"
#include "core/base/inline_vector.h"
#include "core/rig/rig.h"
#include "core/wire/message.h"
#include "hal/clock.h"
#include "hal/serial_port.h"

namespace facewire::app {

struct HostLineCounters {
  std::uint64_t poses = 0;          // handed to the line completely
  std::uint64_t poses_dropped = 0;  // not handed over in their tick
  std::uint64_t bytes = 0;
  std::uint64_t write_errors = 0;
  std::uint64_t hang_ups = 0;  // times that an open line was lost
  std::uint64_t opens = 0;
};

// The service's end of the line to the host: frames out, commands in. Never waits longer than the
// budget of a tick, never allocates (opening aside). What is sent first: the rest of a frame that
// the line took in part (a receiver must not see half a frame), acknowledgements, the pose, the
// status, of the rig's description as much as the line still takes, and in what room is left then,
// without waiting, landmarks for a host that asked.
class HostLine {
 public:
  // `port` may be null: nothing is sent, and nothing is ever missing. All are borrowed. `baud` is
  // what OSC fits itself to; the native protocol does not need to know.
  HostLine(hal::SerialPort* port, hal::Clock& clock, std::chrono::milliseconds budget,
           HostProtocol protocol = HostProtocol::kNative, int baud = 115200) noexcept;

  // The rig that poses belong to; borrowed until the next call. Its description is sent at once.
  void SetRig(const Rig& rig, std::uint32_t rig_id) noexcept;

  // Opens the line; later on it is reopened by itself, with back-off. Errors as SerialPort::Open.
  Result<> Open() noexcept;
  // Sends everything about the rig again. Asked in the middle of it, it goes on from there and
  // round, so that a host which asks faster than the line carries still gets every part.
  void Describe() noexcept;

  // The next command that has arrived, without waiting.
  std::optional<wire::Command> NextCommand() noexcept;
  // Queues the answer; it leaves with the next Send.
  void Acknowledge(const wire::Acknowledgement& answer) noexcept;

  // As LandmarkFeed. The host that asked gets what is offered before a Send with that Send and
  // those that follow, as the line has room; after a lost line it must ask again.
  bool AskLandmarks(float pictures_a_second) noexcept;
  bool landmarks_asked() const noexcept { return landmarks_.asked(clock_.Now()); }
  void OfferLandmarks(const Landmarks& newest) noexcept { landmarks_.Offer(newest); }

  // One tick: reopens a lost line when it is time, then sends. `status` may be null: not due.
  // True when the pose was handed over completely.
  bool Send(const wire::Pose& pose, const wire::Status* status) noexcept;

  // Whether there is a line at all.
  bool exists() const noexcept { return port_ != nullptr; }
  // False while a line that there should be is closed.
  bool connected() const noexcept { return port_ == nullptr || open_; }
  // For how long an open line has taken no byte (every tick has a pose for it); zero while closed.
  Duration TakesNothingFor() const noexcept;
  const HostLineCounters& counters() const noexcept { return counters_; }
  const wire::LinkStats& received() const noexcept;

 private:
  template <class Use>
  decltype(auto) WithSpeech(Use use) noexcept;
  template <class Message>
  bool Frame(const Message& message) noexcept;
  bool Hold(Result<std::span<const std::byte>> frame) noexcept;
  bool Flush(Time deadline) noexcept;
  bool FlushOrDrop(Time deadline) noexcept;
  bool HasRoom() const noexcept;
  bool SendPose(const wire::Pose& pose, Time deadline) noexcept;
  void SendAcknowledgements(Time deadline) noexcept;
  void SendDescription(Time deadline) noexcept;
  void SendLandmarks() noexcept;
  void MeasureRoom() noexcept;
  void Lose(Errc why) noexcept;

  hal::SerialPort* port_;
  hal::Clock& clock_;
  std::chrono::milliseconds budget_;
  Backoff reopen_;
  bool open_ = false;
  Time taken_{};  // the line took something at that time, or was opened

  const Rig* rig_ = nullptr;
  std::uint32_t rig_id_ = 0;
  std::size_t next_part_ = 0;   // of the description
  std::size_t parts_left_ = 0;  // of it, to be sent

  LandmarkFeed landmarks_;
  SpareRoom room_;
  std::uint64_t bytes_at_pose_ = 0;  // of counters_, before the last pose

  HostProtocol protocol_;
  NativeSpeech native_;
  OscSpeech osc_;
  std::array<std::byte, wire::kMaxFrameBytes> out_{};
  std::size_t out_begin_ = 0;  // of what is still to be sent of out_
  std::size_t out_end_ = 0;

  std::array<std::byte, 512> in_{};
  std::span<const std::byte> unread_;  // part of in_
  InlineVector<wire::Acknowledgement, 16> answers_;
  HostLineCounters counters_;
};

}  // namespace facewire::app

#endif  // FACEWIRE_APP_HOST_LINE_H_
