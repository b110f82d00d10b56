#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "app/error.h"
#include "tools/markers/take.h"

namespace facewire::tools::markers {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::size_t kBlock = 512;

template <class T>
void Put(std::string& out, std::size_t at, T value) {
  std::memcpy(out.data() + at, &value, sizeof(T));
}
template <class T>
void Append(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

// What the tests vary of a small file: two points, two frames, one analogue word a frame.
struct Context {
  bool reals = true;
  float scale = 0.5F;
  std::uint8_t processor = 84;
  std::string units = "mm";
  std::vector<std::vector<double>> frames{{10, 20, 30, 0, 1, 2, 3, 0},
                                          {12, 22, 32, 0, 0, 0, 0, -1}};

  std::string Parameter(std::int8_t group, const std::string& name, std::int8_t type,
                        const std::vector<std::uint8_t>& dimensions,
                        const std::string& data) const {
    std::string out;
    Append(out, static_cast<std::int8_t>(name.size()));
    Append(out, group);
    out += name;
    Append(out, static_cast<std::uint16_t>(2 + 2 + dimensions.size() + data.size() + 1));
    Append(out, type);
    Append(out, static_cast<std::uint8_t>(dimensions.size()));
    for (const std::uint8_t d : dimensions) Append(out, d);
    return out + data + '\0';
  }

  std::string Call() const {
    std::string header(kBlock, '\0');
    Put<std::uint8_t>(header, 0, 2);
    Put<std::uint8_t>(header, 1, 0x50);
    Put<std::uint16_t>(header, 2, 2);
    Put<std::uint16_t>(header, 4, 1);
    Put<std::uint16_t>(header, 6, 1);
    Put<std::uint16_t>(header, 8, static_cast<std::uint16_t>(frames.size()));
    Put<float>(header, 12, reals ? -1.0F : scale);
    Put<std::uint16_t>(header, 16, 3);
    Put<float>(header, 20, 50.0F);

    std::string parameters("\1\x50\1", 3);
    Append(parameters, processor);
    std::string rate;
    Append(rate, 60.0F);
    // The parameters come before the group that names them: the format allows it.
    parameters += Parameter(1, "LABELS", -1, {4, 2}, "jaw brow");
    parameters += Parameter(1, "UNITS", -1, {static_cast<std::uint8_t>(units.size())}, units);
    parameters += Parameter(1, "RATE", 4, {}, rate);
    Append(parameters, static_cast<std::int8_t>(-5));  // a locked group
    Append(parameters, static_cast<std::int8_t>(-1));
    parameters += "POINT";
    Append(parameters, std::uint16_t{0});
    parameters.resize(kBlock, '\0');

    std::string data;
    for (const auto& frame : frames) {
      for (const double v : frame) Number(data, v);
      Number(data, 7);  // analogue
    }
    return header + parameters + data;
  }

  void Number(std::string& out, double v) const {
    if (reals) {
      Append(out, static_cast<float>(v));
    } else {
      Append(out, static_cast<std::int16_t>(v));
    }
  }

  std::string Error() const {
    try {
      (void)ReadC3d(Call(), "m.c3d");
    } catch (const app::BadInput& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST(MarkerC3d, ReadsRealNumbersNamesRateAndUnit) {
  const Take take = ReadC3d(Context{}.Call(), "m.c3d");
  EXPECT_THAT(take.names, ElementsAre("jaw", "brow"));
  EXPECT_EQ(take.rate_hz, 60);
  ASSERT_EQ(take.frames.size(), 2U);
  EXPECT_EQ(take.frames[0][0], (Point3{1, 2, 3}));
  EXPECT_NEAR(take.frames[1][0].y, 2.2F, 1e-6F);
}

TEST(MarkerC3d, ReadsScaledIntegers) {
  Context context;
  context.reals = false;
  const Take take = ReadC3d(context.Call(), "m.c3d");
  EXPECT_EQ(take.frames[0][0], (Point3{0.5F, 1, 1.5F}));
}

TEST(MarkerC3d, TakesANegativeResidualAsAGap) {
  EXPECT_TRUE(std::isnan(ReadC3d(Context{}.Call(), "m.c3d").frames[1][1].x));
}

TEST(MarkerC3d, RefusesOtherProcessorsUnitsAndFiles) {
  Context dec;
  dec.processor = 85;
  EXPECT_THAT(dec.Error(), HasSubstr("processor type 85; only type 84 (Intel)"));
  Context unit;
  unit.units = "yd";
  EXPECT_THAT(unit.Error(), HasSubstr("\"yd\""));
  EXPECT_THROW((void)ReadC3d(std::string(600, 'x'), "m.c3d"), app::BadInput);
  EXPECT_THROW((void)ReadC3d("", "m.c3d"), app::BadInput);
}

TEST(MarkerC3d, NeverReadsPastTheEndHoweverItIsCut) {
  const std::string whole = Context{}.Call();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THROW((void)ReadC3d(whole.substr(0, size), "m.c3d"), app::BadInput) << size;
  }
}

TEST(MarkerC3d, SurvivesAnyOneDamagedByteOfItsHeaders) {
  const std::string whole = Context{}.Call();
  for (std::size_t at = 0; at < 2 * kBlock; ++at) {
    for (const char byte : {'\0', '\x7f', '\x80', '\xff'}) {
      std::string damaged = whole;
      damaged[at] = byte;
      try {
        (void)ReadC3d(damaged, "m.c3d");
      } catch (const app::BadInput&) {
        // Refusing is as good as reading something else: it must only not crash.
      }
    }
  }
}

}  // namespace
}  // namespace facewire::tools::markers
