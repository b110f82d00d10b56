#include "app/animatronic/bus_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "app/config.h"
#include "app/toml_reader.h"
#include "tests/app/scratch.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;

std::vector<ServoBusConfig> Read(const std::string& text) {
  const Scratch scratch;
  return LoadConfig(scratch.Write("facewire.toml", text)).buses;
}

std::string Complaint(const std::string& text) {
  const Scratch scratch;
  const auto file = scratch.Write("facewire.toml", text);
  return Replaced(ProblemsOf([&] { (void)LoadConfig(file); }), file.string(), "F");
}

// A bus of that kind; what follows belongs to it.
std::string Bus(const std::string& kind, const std::string& more = "") {
  return "[[bus]]\nname = \"b\"\nkind = \"" + kind + "\"\nport = \"serial:/dev/x\"\n" + more;
}

TEST(Buses, AreNoneUnlessTheFileHasSome) { EXPECT_TRUE(Read("").empty()); }

TEST(Buses, HaveTheRatesTheirKindIsDeliveredWith) {
  struct Row {
    const char* kind;
    int baud, rate_hz;
  };
  for (const Row& row : {Row{"maestro", 115'200, 50}, Row{"receiver", 115'200, 50},
                         Row{"dynamixel", 57'600, 100}, Row{"feetech", 1'000'000, 100}}) {
    const auto buses = Read(Bus(row.kind));
    ASSERT_EQ(buses.size(), 1U) << row.kind;
    EXPECT_EQ(buses[0].baud, row.baud) << row.kind;
    EXPECT_EQ(buses[0].rate_hz, row.rate_hz) << row.kind;
    EXPECT_STREQ(Name(buses[0].kind), row.kind);
  }
}

TEST(Buses, FindTheirPortBesideTheFile) {
  const Scratch scratch;
  const auto file = scratch.Write(
      "facewire.toml", "[[bus]]\nname = \"b\"\nkind = \"maestro\"\nport = \"pty:link\"\n");
  EXPECT_EQ(LoadConfig(file).buses[0].port, "pty:" + (file.parent_path() / "link").string());
}

struct Row {
  std::string text;
  const char* complaint;
};

TEST(Buses, SayWhatIsWrongWhereAndWhatWouldBeRight) {
  const Row table[] = {
      {"[[bus]]\n",
       "F:1:1: bus[0]: \"name\" is missing: the one that servos of the rig have as bus\n"
       "F:1:1: bus[0]: \"kind\" is missing: what hangs on the port\n"
       "F:1:1: bus[0]: \"port\" is missing: as \"serial:/dev/ttyACM0\"; /dev/serial/by-id/... "
       "stays the same"},
      {Bus("pwm"),
       "F:3:8: bus[0].kind: \"pwm\" is none of \"maestro\", \"dynamixel\", \"feetech\", "
       "\"receiver\""},
      {"[[bus]]\nname = \"b\"\nkind = \"maestro\"\nport = \"none\"\n",
       "F:4:8: bus[0].port: \"none\" is not understood; expected \"serial:/dev/ttyACM0\" or "
       "\"pty:LINK\""},
      {Bus("maestro", "rate_hz = 20\n"),
       "F:5:11: bus[0].rate_hz: 20 is out of range; allowed: 50 to 200 Hz"},
      {Bus("maestro", "warm_c = 70\n"),
       "F:5:10: bus[0].warm_c: warm_c, 70, is not below hot_c, 65"},
      {Bus("maestro", "hot_c = 40\n"),
       "F:5:9: bus[0].hot_c: warm_c, 55, is not below hot_c, 40\n"
       "F:5:9: bus[0].hot_c: cool_c, 50, is not below hot_c, 40"},
      {Bus("maestro", "max_load = 0.5\n"),
       "F:5:12: bus[0].max_load: high_load, 0.6, is not below max_load, 0.5"},
      {Bus("maestro", "refresh_ms = 0\n"), "F:5:14: bus[0].refresh_ms: must be above 0"},
      {Bus("maestro", "watchdog_ms = 500\n"),
       "F:5:15: bus[0].watchdog_ms: is for kind = \"dynamixel\", and this bus is \"maestro\"; take "
       "it out"},
      {Bus("dynamixel", "watchdog_ms = 200\n"),
       "F:5:15: bus[0].watchdog_ms: 200 ms bites while all is well: a pose that stands still is "
       "sent every refresh_ms, 100 ms; expected 300 ms at least"},
      {Bus("feetech", "multi_targets = true\n"), "F:5:1: unknown key \"bus[0].multi_targets\""},
      {Bus("maestro") + Bus("feetech"),
       "F:6:8: bus[1].name: a second bus \"b\"; every name may be there once\n"
       "F:8:8: bus[1].port: is bus \"b\"'s already; give each its own"},
  };
  for (const Row& row : table) EXPECT_THAT(Complaint(row.text), testing::StartsWith(row.complaint));
}

TEST(Buses, AreEightAtMost) {
  std::string text;
  for (int i = 0; i < 9; ++i) {
    const std::string n = std::to_string(i);
    text += "[[bus]]\nname = \"b" + n + "\"\nkind = \"maestro\"\nport = \"serial:" + n + "\"\n";
  }
  EXPECT_EQ(Complaint(text), "F:34:8: bus[8].name: too many buses; the most is 8");
}

// The example's [[bus]] tables are comments, because a bus that is not there is a mistake. This is
// the file with them.
std::string ExampleWithBuses() {
  std::ifstream file(std::string(FACEWIRE_SOURCE_DIR) + "/app/share/facewire.toml");
  std::string text;
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    inside = line == "# [[bus]]" || (inside && line.starts_with("# "));
    text += (inside ? line.substr(2) : line) + "\n";
  }
  return text;
}

TEST(ExampleBuses, AreTheDefaultsOfTheirKind) {
  const auto example = Read(ExampleWithBuses());
  ASSERT_EQ(example.size(), 4U);
  std::string plain;
  for (const ServoBusConfig& bus : example) {
    plain += "[[bus]]\nname = \"" + bus.name + "\"\nkind = \"" + Name(bus.kind) + "\"\nport = \"" +
             bus.port + "\"\n";
  }
  const auto defaults = Read(plain);
  ASSERT_EQ(defaults.size(), example.size());
  for (std::size_t i = 0; i < example.size(); ++i) {
    const ServoBusConfig& a = example[i];
    const ServoBusConfig& b = defaults[i];
    EXPECT_EQ(a.baud, b.baud);
    EXPECT_EQ(a.rate_hz, b.rate_hz);
    EXPECT_EQ(a.reply_timeout, b.reply_timeout);
    EXPECT_EQ(a.feedback_share, b.feedback_share);
    EXPECT_EQ(a.refresh, b.refresh);
    EXPECT_EQ(a.guard.warm_c, b.guard.warm_c);
    EXPECT_EQ(a.guard.hot_c, b.guard.hot_c);
    EXPECT_EQ(a.guard.cool_c, b.guard.cool_c);
    EXPECT_EQ(a.guard.high_load, b.guard.high_load);
    EXPECT_EQ(a.guard.max_load, b.guard.max_load);
    EXPECT_EQ(a.guard.load_time, b.guard.load_time);
    EXPECT_EQ(a.guard.rest, b.guard.rest);
    EXPECT_EQ(a.maestro.pololu, b.maestro.pololu);
    EXPECT_EQ(a.maestro.device, b.maestro.device);
    EXPECT_EQ(a.maestro.crc, b.maestro.crc);
    EXPECT_EQ(a.multi_target, b.multi_target);
    EXPECT_EQ(a.answers, b.answers);
    EXPECT_EQ(a.watchdog, b.watchdog);
    EXPECT_EQ(a.series, b.series);
    EXPECT_EQ(a.sync_read, b.sync_read);
  }
}

TEST(ExampleBuses, OmitNoKeyThatTheReaderKnows) {
  const std::string example = ExampleWithBuses();
  for (const char* kind : {"maestro", "dynamixel", "feetech", "receiver"}) {
    const std::string what = Complaint(Bus(kind, "qqqqqqqqqqqqqqqqqqqq = 1\n"));
    const std::size_t known = what.find("known: ");
    ASSERT_NE(known, std::string::npos) << what;
    std::istringstream keys(what.substr(known + 7));
    for (std::string key; std::getline(keys >> std::ws, key, ',');) {
      EXPECT_TRUE(std::regex_search(example, std::regex("\n" + key + " = "))) << key;
    }
  }
}

}  // namespace
}  // namespace facewire::app
