#include "tools/facewire/bridge/udp_sender.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "app/error.h"

namespace facewire::tools {
namespace {

void ExpectParsed(const std::string& text, const std::string& host, const std::string& port) {
  const Destination to = ParseDestination("--vmc", text, 39539);
  EXPECT_EQ(to.host, host) << text;
  EXPECT_EQ(to.port, port) << text;
}

void ExpectRefused(const std::string& text, const std::string& why) {
  try {
    ParseDestination("--vmc", text, 39539);
    ADD_FAILURE() << text;
  } catch (const app::BadInput& e) {
    EXPECT_THAT(e.what(), testing::StartsWith("--vmc '" + text + "': "));
    EXPECT_THAT(e.what(), testing::HasSubstr(why));
  }
}

TEST(Destination, IsAHostAndItsPortOrTheProtocols) {
  ExpectParsed("studio:1234", "studio", "1234");
  ExpectParsed("studio", "studio", "39539");
  ExpectParsed("192.168.1.20:1", "192.168.1.20", "1");
  ExpectParsed("[fe80::1%eth0]:65535", "fe80::1%eth0", "65535");
  ExpectParsed("[::1]", "::1", "39539");
}

TEST(Destination, SaysWhatIsWrong) {
  ExpectRefused("", "host is missing");
  ExpectRefused(":39539", "host is missing");
  ExpectRefused("[]:1", "host is missing");
  ExpectRefused("::1", "in brackets");
  ExpectRefused("[::1", "']' is missing");
  for (const char* text : {"studio:", "studio:0", "studio:65536", "studio:12x", "studio:-1",
                           "[::1]1", "[::1]:", "[::1]x1"}) {
    ExpectRefused(text, "a port is a number from 1 to 65535");
  }
}

}  // namespace
}  // namespace facewire::tools
