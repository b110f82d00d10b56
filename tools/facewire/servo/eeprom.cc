#include "tools/facewire/servo/eeprom.h"

#include <chrono>
#include <utility>

#include "app/devices.h"
#include "app/error.h"
#include "tools/facewire/servo/open.h"

namespace facewire::tools {
namespace {

// A Feetech takes 0.8 s to start anew.
constexpr std::chrono::seconds kLongestStart(3);
constexpr std::chrono::milliseconds kBetweenTries(100);

}  // namespace

Eeprom::Eeprom(app::ServoBusConfig bus, std::uint8_t id, MakePort make, hal::Clock& clock)
    : bus_(std::move(bus)), id_(id), make_(std::move(make)), clock_(clock) {}

void Eeprom::OpenPort() {
  chain_.reset();
  port_.reset();  // before the next one: a line has one owner
  port_ = make_(bus_);
  try {
    app::OpenSerialPort(*port_, bus_.port, bus_.baud);
  } catch (const app::BadInput& error) {
    throw app::BadInput(WithService(error.what()));
  }
  line_.emplace(*port_, clock_);
  chain_ = MakeEepromChain(bus_, *line_);
}

void Eeprom::Require(bool good, const std::string& why) const {
  if (!good) {
    throw app::Failure("id " + std::to_string(id_) + " on " + bus_.port + " at " +
                       std::to_string(bus_.baud) + " baud " + why);
  }
}

void Eeprom::Open() {
  OpenPort();
  if (!chain_) {
    throw app::BadInput("bus \"" + bus_.name + "\" is a " + Name(bus_.kind) +
                        ", whose servos keep no settings and know no reboot");
  }
  Require(chain_->Finds(id_), "does not answer; facewire servo find lists who does");
}

void Eeprom::Set(std::string_view setting, std::string_view value) {
  const EepromItem item = chain_->Make(id_, setting, value);
  if (item.new_id && *item.new_id != id_ && chain_->Finds(*item.new_id)) {
    throw app::BadInput("id " + std::to_string(*item.new_id) +
                        " is another servo's already; every servo on a bus has its own");
  }
  chain_->Write(id_, item);
  id_ = item.new_id.value_or(id_);
  if (item.new_baud) {
    bus_.baud = *item.new_baud;
    OpenPort();
  }
  chain_->Close(id_);
  const auto back = chain_->Read(id_, item);
  Require(back.has_value(),
          "does not answer after the change; facewire servo find tells where it is");
  Require(*back == item.data, "has kept something else; list it again");
}

void Eeprom::Reboot() {
  chain_->Reboot(id_);
  const Time end = clock_.Now() + kLongestStart;
  do {
    clock_.SleepUntil(clock_.Now() + kBetweenTries);
    if (chain_->Finds(id_)) return;
  } while (clock_.Now() < end);
  Require(false, "does not come back");
}

}  // namespace facewire::tools
