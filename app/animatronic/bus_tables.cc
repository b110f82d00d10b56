#include "app/animatronic/bus_tables.h"

#include <chrono>
#include <string>
#include <string_view>

#include "app/address_reader.h"
#include "core/base/capacity.h"

namespace facewire::app {
namespace {

using bus::FeetechSeries;

constexpr int kLongestReplyMs = 1000;
constexpr int kLongestRefreshMs = 1000;
constexpr int kHourMs = 3'600'000;

std::string Milliseconds(Duration d) {
  return std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(d).count()) + " ms";
}

class BusReader {
 public:
  explicit BusReader(const std::filesystem::path& folder) : folder_(folder) {}

  void Read(TableReader& table) {
    ServoBusConfig bus;
    ReadIdentity(table, bus);
    table.Integer("baud", bus.baud, 1200, 4'000'000, "baud");
    table.Integer("rate_hz", bus.rate_hz, 50, 200, "Hz");
    ReadTalk(table, bus);
    ReadGuard(table, bus.guard);
    ReadMaestro(table, bus);
    ReadDynamixel(table, bus);
    ReadFeetech(table, bus);
    table.Finish();
    if (buses_.size() == kMaxBuses) {
      table.Problem("name", "too many buses; the most is " + std::to_string(kMaxBuses));
    } else {
      buses_.push_back(bus);
    }
  }

  std::vector<ServoBusConfig> Done() && { return std::move(buses_); }

 private:
  void ReadIdentity(TableReader& table, ServoBusConfig& bus) {
    ShortName name;
    if (table.Require("name", "the one that servos of the rig have as bus")) {
      table.Name("name", name);
    }
    bus.name = name.view();
    for (const ServoBusConfig& other : buses_) {
      if (other.name != bus.name || bus.name.empty()) continue;
      table.Problem("name", "a second bus \"" + bus.name + "\"; every name may be there once");
    }
    table.Require("kind", "what hangs on the port");
    table.Choice<BusKind>("kind", bus.kind,
                          {{Name(BusKind::kMaestro), BusKind::kMaestro},
                           {Name(BusKind::kDynamixel), BusKind::kDynamixel},
                           {Name(BusKind::kFeetech), BusKind::kFeetech},
                           {Name(BusKind::kReceiver), BusKind::kReceiver}});
    bus.baud = DefaultBaud(bus.kind);
    bus.rate_hz = DefaultRate(bus.kind);
    if (!table.Require("port",
                       R"(as "serial:/dev/ttyACM0"; /dev/serial/by-id/... stays the same)")) {
      return;
    }
    ReadLineAddress(table, "port", folder_, false, bus.port);
    for (const ServoBusConfig& other : buses_) {
      if (other.port != bus.port || bus.port.empty()) continue;
      table.Problem("port", "is bus \"" + other.name + "\"'s already; give each its own");
    }
  }

  static void ReadTalk(TableReader& table, ServoBusConfig& bus) {
    table.Milliseconds("reply_timeout_ms", bus.reply_timeout, kLongestReplyMs);
    table.Number("feedback_share", bus.feedback_share, {0.01, 0.9});
    table.Milliseconds("refresh_ms", bus.refresh, kLongestRefreshMs);
    for (const auto& [key, time] :
         {std::pair("reply_timeout_ms", bus.reply_timeout), {"refresh_ms", bus.refresh}}) {
      if (time == Duration::zero()) table.Problem(key, "must be above 0");
    }
  }

  static void ReadGuard(TableReader& table, bus::GuardConfig& guard) {
    for (const auto& [key, value] :
         {std::pair("warm_c", &guard.warm_c), {"hot_c", &guard.hot_c}, {"cool_c", &guard.cool_c}}) {
      table.Number(key, *value, {0, 150, "degrees Celsius"});
    }
    table.Number("high_load", guard.high_load, {0, 1});
    table.Number("max_load", guard.max_load, {0, 1});
    table.Milliseconds("load_time_ms", guard.load_time, kHourMs);
    table.Milliseconds("rest_ms", guard.rest, kHourMs);
    if (guard.warm_c >= guard.hot_c) {
      table.Problem(
          table.Has("hot_c") ? "hot_c" : "warm_c",
          "warm_c, " + Printed(guard.warm_c) + ", is not below hot_c, " + Printed(guard.hot_c));
    }
    if (guard.cool_c >= guard.hot_c) {
      table.Problem(
          table.Has("cool_c") ? "cool_c" : "hot_c",
          "cool_c, " + Printed(guard.cool_c) + ", is not below hot_c, " + Printed(guard.hot_c));
    }
    if (guard.high_load >= guard.max_load) {
      table.Problem(table.Has("high_load") ? "high_load" : "max_load",
                    "high_load, " + Printed(guard.high_load) + ", is not below max_load, " +
                        Printed(guard.max_load));
    }
  }

  // Whether this bus is of that kind; on another its keys are a problem.
  static bool Has(TableReader& table, const ServoBusConfig& bus, BusKind kind,
                  std::initializer_list<std::string_view> keys) {
    if (bus.kind == kind) return true;
    for (const std::string_view key : keys) {
      if (!table.Has(key)) continue;
      table.Leave(key);
      table.Problem(key, std::string("is for kind = \"") + Name(kind) + "\", and this bus is \"" +
                             Name(bus.kind) + "\"; take it out");
    }
    return false;
  }

  static void ReadMaestro(TableReader& table, ServoBusConfig& bus) {
    if (!Has(table, bus, BusKind::kMaestro,
             {"protocol", "device", "crc", "multi_target", "answers"})) {
      return;
    }
    table.Choice<bool>("protocol", bus.maestro.pololu, {{"compact", false}, {"pololu", true}});
    int device = bus.maestro.device;
    table.Integer("device", device, 0, 127);
    bus.maestro.device = static_cast<std::uint8_t>(device);
    table.Flag("crc", bus.maestro.crc);
    table.Flag("multi_target", bus.multi_target);
    table.Flag("answers", bus.answers);
  }

  static void ReadDynamixel(TableReader& table, ServoBusConfig& bus) {
    if (!Has(table, bus, BusKind::kDynamixel, {"watchdog_ms"})) return;
    const auto longest = std::chrono::duration_cast<std::chrono::milliseconds>(kLongestWatchdog);
    table.Milliseconds("watchdog_ms", bus.watchdog, static_cast<int>(longest.count()));
    if (bus.watchdog == Duration::zero()) return;
    if (bus.watchdog < kRefreshesPerWatchdog * bus.refresh) {
      table.Problem("watchdog_ms", Milliseconds(bus.watchdog) +
                                       " bites while all is well: a pose that stands still is sent "
                                       "every refresh_ms, " +
                                       Milliseconds(bus.refresh) + "; expected " +
                                       Milliseconds(kRefreshesPerWatchdog * bus.refresh) +
                                       " at least");
    }
  }

  static void ReadFeetech(TableReader& table, ServoBusConfig& bus) {
    if (!Has(table, bus, BusKind::kFeetech, {"series", "sync_read"})) return;
    table.Choice<FeetechSeries>("series", bus.series,
                                {{"sts", FeetechSeries::kSts}, {"scs", FeetechSeries::kScs}});
    table.Flag("sync_read", bus.sync_read);
  }

  const std::filesystem::path& folder_;
  std::vector<ServoBusConfig> buses_;
};

}  // namespace

std::vector<ServoBusConfig> ReadBuses(TableReader& top, const std::filesystem::path& folder) {
  BusReader reader(folder);
  top.EachTable("bus", [&](TableReader& table) { reader.Read(table); });
  return std::move(reader).Done();
}

}  // namespace facewire::app
