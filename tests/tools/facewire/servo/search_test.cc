#include "tools/facewire/servo/search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "app/error.h"
#include "core/wire/encoder.h"
#include "hal/fake/fake_serial_port.h"
#include "tests/sim/dynamixel.h"
#include "tests/sim/feetech.h"
#include "tests/sim/maestro.h"
#include "tests/tools/facewire/servo/simulated_port.h"

namespace facewire::tools {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

struct Context {
  hal::fake::FakeClock clock;
  SearchPlan plan;
  std::vector<std::string> steps;

  PortSearch Search(sim::Bus& bus, int bus_baud) {
    bus.Advance(clock.Now());
    clock.Advance(std::chrono::seconds(1));  // the servos have started
    bus.Advance(clock.Now());
    return SearchPort(
        "/dev/test",
        [&](int baud) { return std::make_unique<SimulatedPort>(bus, clock, bus_baud, baud); },
        clock, plan, [&](const std::string& step) { steps.push_back(step); });
  }
};

void ExpectNothingMovedNorWasSet(sim::Bus& bus) {
  for (std::size_t i = 0; i < bus.servos(); ++i) EXPECT_FALSE(bus.TorqueOn(i)) << i;
  EXPECT_EQ(bus.trace().Count(sim::EventKind::kTorqueOn), 0U);
  EXPECT_EQ(bus.trace().Count(sim::EventKind::kEepromWrite), 0U);
}

class DynamixelAtEveryRate : public testing::TestWithParam<int> {};

TEST_P(DynamixelAtEveryRate, IsFoundWithModelHeatAndVoltage) {
  Context context;
  sim::DynamixelOptions options;
  options.ids = {1, 7, 252};
  options.baud = GetParam();
  options.poses = {1000};
  sim::Dynamixel bus(options);
  const PortSearch search = context.Search(bus, GetParam());
  ASSERT_THAT(search.buses, SizeIs(1));
  const FoundBus& found = search.buses[0];
  EXPECT_EQ(found.protocol, Protocol::kDynamixel);
  EXPECT_EQ(found.baud, GetParam());
  ASSERT_THAT(found.servos, SizeIs(3));
  EXPECT_EQ(found.servos[0].id, 1);
  EXPECT_EQ(found.servos[2].id, 252);
  EXPECT_EQ(found.servos[0].model, "XL330-M288");
  EXPECT_NEAR(found.servos[0].position.value_or(0), 1000, 60);  // it sags
  EXPECT_NEAR(found.servos[0].temperature_c.value_or(0), 25, 2);
  EXPECT_NEAR(found.servos[0].voltage_v.value_or(0), 5, 0.2);
  ExpectNothingMovedNorWasSet(bus);
}

INSTANTIATE_TEST_SUITE_P(Rates, DynamixelAtEveryRate,
                         testing::Values(57'600, 115'200, 1'000'000, 2'000'000, 3'000'000,
                                         4'000'000));

TEST(ServoSearch, FindsFeetechServosOfBothSeries) {
  for (const bool scs : {false, true}) {
    Context context;
    sim::FeetechOptions options(scs ? sim::Scs() : sim::Sts());
    options.ids = {0, 20};
    options.baud = 500'000;
    sim::Feetech bus(options);
    const PortSearch search = context.Search(bus, 500'000);
    ASSERT_THAT(search.buses, SizeIs(1));
    EXPECT_EQ(search.buses[0].protocol, Protocol::kFeetech);
    EXPECT_EQ(search.buses[0].scs, scs);
    EXPECT_EQ(search.buses[0].baud, 500'000);
    ASSERT_THAT(search.buses[0].servos, SizeIs(2));
    const FoundServo& servo = search.buses[0].servos[1];
    EXPECT_EQ(servo.id, 20);
    EXPECT_EQ(servo.model, scs ? "SC09" : "STS3215");
    EXPECT_NEAR(servo.position.value_or(0), scs ? 512 : 2048, 60);
    EXPECT_NEAR(servo.voltage_v.value_or(0), scs ? 6.0 : 7.4, 0.3);
    ExpectNothingMovedNorWasSet(bus);
  }
}

TEST(ServoSearch, AsksTheHighFeetechIdsOnlyWhenToldTo) {
  Context context;
  sim::FeetechOptions options;
  options.ids = {21};
  sim::Feetech bus(options);
  context.plan.protocols = {Protocol::kFeetech};
  context.plan.rates = {1'000'000};
  EXPECT_THAT(context.Search(bus, 1'000'000).buses, IsEmpty());
  context.plan.all_ids = true;
  EXPECT_THAT(context.Search(bus, 1'000'000).buses, SizeIs(1));
}

TEST(ServoSearch, DoesNotTakeAnAdapterThatEchoesForServos) {
  sim::FeetechOptions options;
  options.ids = {3};
  options.echo = true;
  Context context;
  sim::Feetech bus(options);
  const PortSearch search = context.Search(bus, 1'000'000);
  ASSERT_THAT(search.buses, SizeIs(1));
  ASSERT_THAT(search.buses[0].servos, SizeIs(1));
  EXPECT_EQ(search.buses[0].servos[0].id, 3);
}

TEST(ServoSearch, FindsAMaestroWithoutSendingItHome) {
  for (const bool crc : {false, true}) {
    for (const int device : {12, 3}) {
      Context context;
      sim::MaestroOptions options;
      options.crc = crc;
      options.device_number = static_cast<std::uint8_t>(device);
      sim::Maestro bus(options);
      const PortSearch search = context.Search(bus, 0);
      ASSERT_THAT(search.buses, SizeIs(1)) << crc << device;
      EXPECT_EQ(search.buses[0].protocol, Protocol::kMaestro);
      EXPECT_EQ(search.buses[0].crc, crc);
      // Any error would have sent it there.
      EXPECT_EQ(bus.errors(), 0U);
      EXPECT_EQ(bus.trace().Count(sim::EventKind::kError), 0U);
      ExpectNothingMovedNorWasSet(bus);
      EXPECT_THAT(context.steps, Not(testing::Contains(HasSubstr("Dynamixel"))));
    }
  }
}

// A board on wires that waits for the first AA to learn the rate.
TEST(ServoSearch, FindsAMaestroThatDetectsTheRate) {
  Context context;
  sim::MaestroOptions options;
  options.port = sim::MaestroOptions::Port::kRx;
  options.serial_mode = sim::MaestroOptions::SerialMode::kUartDetectBaud;
  options.baud = 115'200;
  sim::Maestro bus(options);
  EXPECT_THAT(context.Search(bus, 0).buses, SizeIs(1));
}

TEST(ServoSearch, AReceiverIsFoundByItsStatus) {
  Context context;
  context.clock.Advance(std::chrono::seconds(1));
  hal::fake::FakeSerialPort* port = nullptr;
  std::array<std::byte, 1024> buffer;
  wire::Encoder encoder;
  const auto frame = *encoder.Encode(
      wire::ReceiverStatus{.capacity = 12, .version_major = 1, .version_minor = 3}, buffer);
  const PortSearch search = SearchPort(
      "/dev/test",
      [&](int) {
        auto made = std::make_unique<hal::fake::FakeSerialPort>(context.clock);
        port = made.get();
        EXPECT_TRUE(made->Feed(frame, context.clock.Now() + milliseconds(1900)));
        return made;
      },
      context.clock, context.plan, [](const auto&) {});
  ASSERT_THAT(search.buses, SizeIs(1));
  EXPECT_EQ(search.buses[0].protocol, Protocol::kReceiver);
  EXPECT_EQ(search.buses[0].about, "firmware 1.3, 12 servos");
}

TEST(ServoSearch, SaysWhatWasTriedWhereNothingIs) {
  Context context;
  sim::Feetech bus{sim::FeetechOptions{}};
  const PortSearch search = context.Search(bus, 1);  // deaf to all
  EXPECT_THAT(search.buses, IsEmpty());
  EXPECT_THAT(search.tried,
              ElementsAre("facewire receiver at 115200 baud", "Pololu Maestro at 115200, 9600 baud",
                          "Dynamixel at 57600, 1000000, 115200, 2000000, 3000000, 4000000 baud",
                          "Feetech at 1000000, 500000, 115200, 250000, 57600, 38400 baud"));
}

TEST(ServoSearch, LeavesOutARateThatThePortCannotDo) {
  Context context;
  context.plan.protocols = {Protocol::kDynamixel};
  std::size_t opened = 0;
  const PortSearch search = SearchPort(
      "/dev/test",
      [&](int baud) {
        auto port = std::make_unique<hal::fake::FakeSerialPort>(context.clock);
        if (baud > 1'000'000) port->FailOpens(9, Errc::kUnsupported);
        ++opened;
        return port;
      },
      context.clock, context.plan, [](const auto&) {});
  EXPECT_EQ(opened, 6U);
  EXPECT_THAT(search.tried, ElementsAre("Dynamixel at 57600, 1000000, 115200 baud"));
}

TEST(ServoSearch, APortThatIsInUseIsOneClearLine) {
  Context context;
  try {
    (void)SearchPort(
        "/dev/test",
        [&](int) {
          auto port = std::make_unique<hal::fake::FakeSerialPort>(context.clock);
          port->FailOpens(9, Errc::kBusy);
          return port;
        },
        context.clock, context.plan, [](const auto&) {});
    FAIL();
  } catch (const app::BadInput& error) {
    EXPECT_STREQ(error.what(), "/dev/test is in use by another program; end that one first");
  }
}

TEST(FoundBusText, IsATableAndABlockToPaste) {
  FoundBus bus{.protocol = Protocol::kFeetech, .port = "/dev/x", .baud = 1'000'000};
  bus.servos.push_back({.id = 3, .model = "STS3215", .position = 2047, .temperature_c = 25.0F});
  EXPECT_EQ(Describe(bus),
            "/dev/x: Feetech at 1000000 baud\n"
            "    id   model           position  temperature  voltage\n"
            "    3    STS3215         2047      25 C         -\n");
  EXPECT_EQ(BusBlock(bus, "head"),
            "[[bus]]\nname = \"head\"\nkind = \"feetech\"\nport = \"serial:/dev/x\"\n"
            "baud = 1000000\nseries = \"sts\"\n");
}

}  // namespace
}  // namespace facewire::tools
