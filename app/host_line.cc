#include "app/host_line.h"

#include <algorithm>

#include "core/wire/rig_description.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;

// At most so many parts of the description ride on one tick: on a slow line the poses come first.
constexpr int kPartsPerTick = 4;

static_assert(wire::kMaxFrameBytes >= wire::osc::MaxSlipBytes(wire::osc_host::kMaxPacketBytes));

}  // namespace

HostLine::HostLine(hal::SerialPort* port, hal::Clock& clock, milliseconds budget,
                   HostProtocol protocol, int baud) noexcept
    : port_(port), clock_(clock), budget_(budget), protocol_(protocol), osc_(baud) {}

// What `use` does with the speech that this line has.
template <class Use>
decltype(auto) HostLine::WithSpeech(Use use) noexcept {
  return protocol_ == HostProtocol::kOsc ? use(osc_) : use(native_);
}

void HostLine::SetRig(const Rig& rig, std::uint32_t rig_id) noexcept {
  WithSpeech([&](auto& speech) { speech.SetRig(rig); });
  rig_ = &rig;
  rig_id_ = rig_id;
  next_part_ = 0;
  Describe();
}

void HostLine::Describe() noexcept {
  parts_left_ = rig_ == nullptr ? 0 : wire::DescriptionCount(*rig_);
}

Result<> HostLine::Open() noexcept {
  if (port_ == nullptr) return {};
  const Result<> opened = port_->Open();
  if (!opened) {
    reopen_.Failed(clock_.Now());
    return opened;
  }
  reopen_.Succeeded();
  open_ = true;
  taken_ = clock_.Now();
  WithSpeech([](auto& speech) { speech.LineOpened(); });
  out_begin_ = out_end_ = 0;
  unread_ = {};
  next_part_ = 0;
  landmarks_ = {};
  room_.Forget();
  Describe();
  ++counters_.opens;
  return {};
}

void HostLine::Lose(Errc why) noexcept {
  ++counters_.write_errors;
  if (why != Errc::kDisconnected && why != Errc::kIo) return;
  ++counters_.hang_ups;
  open_ = false;
  port_->Close();
  reopen_.Failed(clock_.Now());
}

std::optional<wire::Command> HostLine::NextCommand() noexcept {
  while (open_) {
    if (unread_.empty()) {
      const auto read = port_->Read(in_, milliseconds(0));
      if (!read) {
        if (read.error() != Errc::kTimeout) Lose(read.error());
        return std::nullopt;
      }
      unread_ = std::span(in_).first(*read);
    }
    const auto command = WithSpeech([this](auto& speech) { return speech.NextCommand(unread_); });
    if (command) return *command;  // else damage was counted, and more bytes are read above
  }
  return std::nullopt;
}

void HostLine::Acknowledge(const wire::Acknowledgement& answer) noexcept {
  // A host that floods the line loses answers, and asks again.
  (void)answers_.try_push(answer);
}

bool HostLine::AskLandmarks(float pictures_a_second) noexcept {
  return landmarks_.Ask(pictures_a_second, clock_.Now());
}

bool HostLine::Send(const wire::Pose& pose, const wire::Status* status) noexcept {
  if (port_ == nullptr) return false;
  if (!open_ && !(reopen_.Due(clock_.Now()) && Open())) return false;
  const Time now = clock_.Now();
  const Time deadline = now + budget_;
  WithSpeech([now](auto& speech) { speech.BeginTick(now); });
  MeasureRoom();
  if (Flush(deadline)) SendAcknowledgements(deadline);
  if (!SendPose(pose, deadline)) {
    ++counters_.poses_dropped;
    return false;
  }
  ++counters_.poses;
  if (status == nullptr || (Frame(*status) && Flush(deadline))) SendDescription(deadline);
  SendLandmarks();
  return true;
}

bool HostLine::SendPose(const wire::Pose& pose, Time deadline) noexcept {
  if (out_end_ != out_begin_) return false;
  return WithSpeech([&](auto& speech) {
    if (!speech.BeginPose(pose)) return false;
    for (;;) {
      const auto frame = speech.NextOfPose(out_);
      if (!frame) return frame.error() == Errc::kEnd;
      if (!Hold(frame) || !FlushOrDrop(deadline)) return false;
    }
  });
}

void HostLine::SendAcknowledgements(Time deadline) noexcept {
  for (const wire::Acknowledgement& answer : answers_) {
    if (!Frame(answer) || !Flush(deadline)) break;
  }
  answers_.clear();
}

void HostLine::SendDescription(Time deadline) noexcept {
  if (rig_ == nullptr) return;
  const std::size_t parts = wire::DescriptionCount(*rig_);
  for (int i = 0; i < kPartsPerTick && parts_left_ > 0; ++i) {
    const Result<wire::Message> part = wire::Description(*rig_, rig_id_, next_part_);
    if (!part || !Frame(*part)) return;
    next_part_ = (next_part_ + 1) % parts;
    --parts_left_;
    if (!Flush(deadline) || !HasRoom()) return;
  }
}

// What the line has done with the bytes since the last pose.
void HostLine::MeasureRoom() noexcept {
  const auto bytes = static_cast<std::size_t>(counters_.bytes - bytes_at_pose_);
  bytes_at_pose_ = counters_.bytes;
  if (!landmarks_asked()) return;
  room_.Measure(out_begin_ == out_end_ && port_->Unsent() == 0, bytes, clock_.Now());
}

void HostLine::SendLandmarks() noexcept {
  if (!landmarks_asked() || parts_left_ > 0) return;
  for (;;) {
    const auto with_part = counters_.bytes - bytes_at_pose_ + wire::kLandmarkPartFrameBytes;
    const std::optional<wire::LandmarkPart> part = landmarks_.part();
    if (!part || !room_.Has(static_cast<std::size_t>(with_part)) || !Frame(*part)) return;
    const bool sent = FlushOrDrop(clock_.Now());
    if (sent || out_begin_ != out_end_) landmarks_.Next();
    if (!sent) return;
  }
}

// Puts the message's frame into the empty buffer. False: the buffer still holds one, or the message
// cannot be encoded.
template <class Message>
bool HostLine::Frame(const Message& message) noexcept {
  if (!open_ || out_end_ != out_begin_) return false;
  return Hold(WithSpeech([&](auto& speech) { return speech.Encode(message, out_); }));
}

bool HostLine::Hold(Result<std::span<const std::byte>> frame) noexcept {
  if (!open_ || !frame) return false;
  out_begin_ = static_cast<std::size_t>(frame->data() - out_.data());
  out_end_ = out_begin_ + frame->size();
  return true;
}

bool HostLine::HasRoom() const noexcept {
  return protocol_ == HostProtocol::kOsc ? osc_.HasRoom() : native_.HasRoom();
}

const wire::LinkStats& HostLine::received() const noexcept {
  return protocol_ == HostProtocol::kOsc ? osc_.received() : native_.received();
}

Duration HostLine::TakesNothingFor() const noexcept {
  return open_ ? clock_.Now() - taken_ : Duration{};
}

// As Flush. A frame of which nothing has left is dropped: the next tick has a newer one. The gap in
// the numbers tells the host.
bool HostLine::FlushOrDrop(Time deadline) noexcept {
  const std::size_t untouched = out_end_ - out_begin_;
  if (Flush(deadline)) return true;
  if (out_end_ - out_begin_ == untouched) out_begin_ = out_end_ = 0;
  return false;
}

// Hands over what the buffer holds. True when it is empty afterwards.
bool HostLine::Flush(Time deadline) noexcept {
  while (open_ && out_begin_ < out_end_) {
    const auto left =
        std::chrono::duration_cast<milliseconds>(std::max(deadline - clock_.Now(), Duration{}));
    const auto taken =
        port_->Write(std::span(out_).subspan(out_begin_, out_end_ - out_begin_), left);
    if (!taken) {
      if (taken.error() != Errc::kTimeout) Lose(taken.error());
      return false;
    }
    out_begin_ += *taken;
    counters_.bytes += *taken;
    if (*taken > 0) taken_ = clock_.Now();
    if (*taken == 0) return false;
  }
  if (!open_) return false;
  out_begin_ = out_end_ = 0;
  return true;
}

}  // namespace facewire::app
