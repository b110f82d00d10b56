// Whatever the bytes of a network file are, loading it gives an answer and reads nothing beside
// them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/track/tracker.h"
#include "tests/support/footage.h"

namespace facewire::track {
namespace {

class CorruptNetworkTest : public testing::TestWithParam<Model> {
 protected:
  CorruptNetworkTest() : good_(GetParam()), block_(Tracker::RequiredBytes(GetParam())) {}

  // Loads, and if that went well tracks a frame.
  Errc Try(const NetworkFiles& files) {
    Arena arena(block_);
    const auto tracker = std::make_unique<Tracker>();
    if (auto loaded = tracker->Load({.model = GetParam()}, files, arena); !loaded)
      return loaded.error();
    static const test::Picture picture = std::move(test::ReadFootage("franck.mp4", 0, 1)[0]);
    (void)tracker->Update(picture.frame());
    (void)tracker->Update(picture.frame());
    return Errc{};
  }

  // Most bytes of a file are weights; these are the others: the start, where tables and shapes are
  // described, and around every change between them. Found by what they look like: small numbers.
  static std::vector<std::size_t> Structure(const std::vector<std::byte>& file) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i + 8 <= file.size(); i += 4) {
      const auto zeros = std::count(file.begin() + static_cast<long>(i),
                                    file.begin() + static_cast<long>(i) + 8, std::byte{0});
      if (zeros >= 4 && zeros < 8) places.push_back(i);
    }
    return places;
  }

  test::NetworkBytes good_;
  std::vector<std::byte> block_;
};

TEST_P(CorruptNetworkTest, TheFilesThemselvesAreFine) { EXPECT_EQ(Try(good_.files()), Errc{}); }

TEST_P(CorruptNetworkTest, ATruncatedFileIsCorrupt) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{4}, std::size_t{1000},
                                 good_.landmarks.size() / 2, good_.landmarks.size() - 4}) {
    const std::vector<std::byte> cut(good_.landmarks.begin(),
                                     good_.landmarks.begin() + static_cast<long>(size));
    EXPECT_EQ(Try({good_.detector, cut}), Errc::kCorrupt) << size;
  }
}

TEST_P(CorruptNetworkTest, TheWrongNetworkIsCorrupt) {
  EXPECT_EQ(Try({good_.landmarks, good_.landmarks}), Errc::kCorrupt);
  EXPECT_EQ(Try({good_.detector, good_.detector}), Errc::kCorrupt);
  const test::NetworkBytes other(GetParam() == Model::kMesh ? Model::kAttention : Model::kMesh);
  EXPECT_EQ(Try({good_.detector, other.landmarks}), Errc::kCorrupt);
}

TEST_P(CorruptNetworkTest, DamageInTheStructureIsSeenOrHarmless) {
  std::mt19937 random(7);
  std::set<Errc> answers;
  const auto places = Structure(good_.landmarks);
  ASSERT_GT(places.size(), 1000U);
  for (int round = 0; round < 300; ++round) {
    auto bad = good_.landmarks;
    for (int i = 0; i < 1 + round % 3; ++i) {
      const std::size_t at = places[random() % places.size()] + random() % 8;
      bad[at] = round % 2 == 0 ? std::byte{static_cast<std::uint8_t>(random())}
                               : bad[at] ^ std::byte{static_cast<std::uint8_t>(1 << random() % 8)};
    }
    answers.insert(Try({good_.detector, bad}));
  }
  // Some damage hits weights and cannot be told; none may give another answer than these.
  for (const Errc answer : answers) {
    EXPECT_TRUE(answer == Errc{} || answer == Errc::kCorrupt || answer == Errc::kFull)
        << Name(answer);
  }
  EXPECT_TRUE(answers.contains(Errc::kCorrupt));
}

TEST_P(CorruptNetworkTest, DamageAnywhereInTheDetectorIsSeenOrHarmless) {
  std::mt19937 random(11);
  for (int round = 0; round < 60; ++round) {
    auto bad = good_.detector;
    for (int i = 0; i < 20; ++i)
      bad[random() % bad.size()] = std::byte{static_cast<std::uint8_t>(random())};
    const Errc answer = Try({bad, good_.landmarks});
    EXPECT_TRUE(answer == Errc{} || answer == Errc::kCorrupt) << Name(answer);
  }
}

TEST_P(CorruptNetworkTest, WeightsThatAreNotNumbersGiveNoFace) {
  auto bad = good_;
  // Half-precision NaNs all over the largest buffer.
  const std::size_t begin = bad.landmarks.size() / 3;
  for (std::size_t i = begin & ~std::size_t{1}; i < begin + 200000; i += 2) {
    bad.landmarks[i] = std::byte{0xff};
    bad.landmarks[i + 1] = std::byte{0x7f};
  }
  const Errc answer = Try(bad.files());
  EXPECT_TRUE(answer == Errc{} || answer == Errc::kCorrupt) << Name(answer);
}

std::string ModelName(const testing::TestParamInfo<Model>& model) {
  return model.param == Model::kMesh ? "Mesh" : "Attention";
}
INSTANTIATE_TEST_SUITE_P(BothModels, CorruptNetworkTest,
                         testing::Values(Model::kAttention, Model::kMesh), ModelName);

}  // namespace
}  // namespace facewire::track
