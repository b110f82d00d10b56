#ifndef FACEWIRE_TOOLS_FACEWIRE_BRIDGE_OUTPUTS_H_
#define FACEWIRE_TOOLS_FACEWIRE_BRIDGE_OUTPUTS_H_

#include <string>

#include "core/rig/rig.h"
#include "core/service_state.h"
#include "core/wire/arkit/arkit.h"
#include "core/wire/ifacialmocap/ifacialmocap.h"
#include "core/wire/vmc/vmc.h"
#include "tools/facewire/bridge/udp_sender.h"

namespace facewire::tools {

// One pose, as display hosts are told it.
struct FaceMoment {
  wire::arkit::Face face;
  ServiceState state = ServiceState::kStarting;
  Time captured{};      // on the device's clock
  float elapsed_s = 0;  // of `captured`, since the first pose
};

// The receiver of one protocol.
class FaceOutput {
 public:
  virtual ~FaceOutput() = default;
  // The poses that follow are of this rig.
  virtual void Begin(const Rig& rig, std::uint32_t rig_id) = 0;
  virtual void Send(const FaceMoment& moment) = 0;
  virtual const UdpSender& sender() const = 0;
};

class VmcOutput final : public FaceOutput {
 public:
  static constexpr int kPort = 39539;
  VmcOutput(const std::string& to, wire::vmc::Names names)
      : sender_("--vmc", to, kPort), names_(names) {}
  void Begin(const Rig& /*rig*/, std::uint32_t /*rig_id*/) override {}
  void Send(const FaceMoment& moment) override;
  const UdpSender& sender() const override { return sender_; }

 private:
  UdpSender sender_;
  wire::vmc::Names names_;
};

class LiveLinkOutput final : public FaceOutput {
 public:
  static constexpr int kPort = 11111;
  // An empty name: that of the rig.
  LiveLinkOutput(const std::string& to, std::string name)
      : sender_("--livelink", to, kPort), wanted_name_(std::move(name)) {}
  void Begin(const Rig& rig, std::uint32_t rig_id) override;
  void Send(const FaceMoment& moment) override;
  const UdpSender& sender() const override { return sender_; }

 private:
  UdpSender sender_;
  std::string wanted_name_;
  std::string name_;
  std::string device_id_;
  bool moved_ = false;  // with the pose before
};

class IFacialMocapOutput final : public FaceOutput {
 public:
  static constexpr int kPort = 49983;
  IFacialMocapOutput(const std::string& to, wire::ifacialmocap::Version version)
      : sender_("--ifacialmocap", to, kPort), version_(version) {}
  void Begin(const Rig& /*rig*/, std::uint32_t /*rig_id*/) override {}
  void Send(const FaceMoment& moment) override;
  const UdpSender& sender() const override { return sender_; }

 private:
  UdpSender sender_;
  wire::ifacialmocap::Version version_;
};

}  // namespace facewire::tools

#endif  // FACEWIRE_TOOLS_FACEWIRE_BRIDGE_OUTPUTS_H_
