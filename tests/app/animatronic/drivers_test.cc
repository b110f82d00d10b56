#include "app/animatronic/drivers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/error.h"
#include "tests/app/animatronic/servos.h"
#include "tests/app/scratch.h"

namespace facewire::app {
namespace {

using testing::ElementsAre;

std::string Complaint(const std::vector<ServoBusConfig>& buses, const servo::ServoRig& rig) {
  return ProblemsOf([&] { const Drivers drivers(buses, rig); });
}

TEST(Drivers, GetTheServosOfTheirBusInTheRigsOrder) {
  const Drivers drivers({BusOf(BusKind::kMaestro, "m"), BusOf(BusKind::kFeetech, "f"),
                         BusOf(BusKind::kDynamixel, "d"), BusOf(BusKind::kReceiver, "r")},
                        RigOf({ServoOf("a", "f", 3), ServoOf("b", "m", 0), ServoOf("c", "f", 1),
                               ServoOf("d", "d", 1), ServoOf("e", "r", 11)}));
  ASSERT_EQ(drivers.attachments().size(), 4U);
  EXPECT_THAT(drivers.attachments()[0].servos.span(), ElementsAre(1));
  EXPECT_THAT(drivers.attachments()[1].servos.span(), ElementsAre(0, 2));
  EXPECT_THAT(drivers.attachments()[2].servos.span(), ElementsAre(3));
  EXPECT_THAT(drivers.attachments()[3].servos.span(), ElementsAre(4));
  EXPECT_EQ(drivers.attachments()[0].period, std::chrono::milliseconds(20));
  EXPECT_EQ(drivers.attachments()[1].period, std::chrono::milliseconds(10));
  EXPECT_EQ(drivers.attachments()[1].driver->feedback().size(), 2U);
}

TEST(Drivers, SayAtOnceEverythingThatABusCannotHave) {
  servo::Servo wide = ServoOf("wide", "f", 1);
  wide.max = 5000;
  EXPECT_EQ(Complaint({BusOf(BusKind::kMaestro, "m"), BusOf(BusKind::kFeetech, "f")},
                      RigOf({ServoOf("jaw", "m", 24), wide, ServoOf("brow", "head", 1)})),
            "servo \"jaw\" of bus \"m\": id 24; channels of a Maestro are 0 to 23\n"
            "servo \"wide\" of bus \"f\": min to max is 1000 to 5000; such servos take 0 to 4095 "
            "counts\n"
            "servo \"brow\": there is no bus \"head\"; the configuration needs a [[bus]] with name "
            "= \"head\"");
}

TEST(Drivers, DoWithoutNoServos) {
  EXPECT_EQ(Complaint({BusOf(BusKind::kMaestro, "m"), BusOf(BusKind::kFeetech, "f")},
                      RigOf({ServoOf("jaw", "m", 1)})),
            "bus \"f\": no servo of the rig is on it; give one bus = \"f\", or take the [[bus]] "
            "out");
}

TEST(Drivers, TakeEveryContractForAWatchdog) {
  for (const int hold_ms : {0, 1, 333, 60'000}) {
    servo::ServoRig rig = RigOf({ServoOf("jaw", "d", 1)});
    rig.contract.hold = std::chrono::milliseconds(hold_ms);
    EXPECT_EQ(Complaint({BusOf(BusKind::kDynamixel, "d")}, rig), "") << hold_ms;
  }
}

}  // namespace
}  // namespace facewire::app
