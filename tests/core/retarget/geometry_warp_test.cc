// The geometry mapping against the truth: characters that are the performer seen through a known
// smooth warp of space, so that every motion has its exact answer. The mapping sees two neutrals.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "core/retarget/geometry_mapping.h"
#include "tests/support/generated_markers.h"

namespace facewire::retarget {
namespace {

using test::MarkerPoints;

float Length(Point3 p) { return std::sqrt(Dot(p, p)); }

// 1 at the centre, fading over `radius_cm`.
float Bump(Point3 p, Point3 centre, float radius_cm) {
  const Point3 d = p - centre;
  return std::exp(-Dot(d, d) / (2 * radius_cm * radius_cm));
}

// Each takes how much of it is wanted; 1 is the character that the test asks for.
struct Warp {
  const char* name;
  Point3 (*at)(Point3, float);
};

constexpr Point3 kMouth{0, -3.6F, 10.3F};
constexpr Point3 kChin{0, -7.4F, 10};

Point3 Anisotropic(Point3 p, float k) {
  return {(1 + 0.3F * k) * p.x, p.y / (1 + 0.25F * k), (1 + 0.4F * k) * p.z};
}
// At the corners, 2.5 cm from the middle, half as much again.
Point3 WideMouth(Point3 p, float k) {
  constexpr float kAtTheCorner = 0.706648F;  // of a bump of 3 cm
  return {p.x * (1 + 0.5F * k / kAtTheCorner * Bump(p, kMouth, 3)), p.y, p.z};
}
Point3 BigChin(Point3 p, float k) {
  const float below = std::log1p(std::exp(kMouth.y - 0.5F - p.y));
  const float share = 1 / (1 + std::exp(p.y - kMouth.y + 0.5F));
  return {p.x * (1 + 0.5F * k * share), p.y - k * below, p.z + k * share};
}
Point3 ForwardChin(Point3 p, float k) { return p + k * Bump(p, kChin, 3) * Point3{0, -1, 2.5F}; }
Point3 BigEyes(Point3 p, float k) {
  for (const Point3 eye : {Point3{-3.2F, 3.2F, 8.5F}, Point3{3.2F, 3.2F, 8.5F}})
    p = p + 0.7F * k * Bump(p, eye, 1.8F) * (p - eye);
  return p;
}
Point3 LongFace(Point3 p, float k) {
  return {p.x, p.y - 0.6F * k * 2 * std::log1p(std::exp((3.9F - p.y) / 2)), p.z};
}
Point3 Pear(Point3 p, float k) { return {p.x * (1 - 0.05F * k * p.y), p.y, p.z}; }
Point3 Muzzle(Point3 p, float k) { return p + k * Bump(p, kMouth, 3.5F) * Point3{0, 0, 3}; }
Point3 Crooked(Point3 p, float k) {
  return {p.x + 0.6F * k * std::sin(p.y / 3), p.y + 0.4F * k * std::sin(p.x / 3),
          p.z + 0.1F * k * p.x};
}

constexpr std::array kWarps = {
    Warp{"anisotropic scale", Anisotropic},
    Warp{"mouth half again as wide", WideMouth},
    Warp{"big chin", BigChin},
    Warp{"chin forward", ForwardChin},
    Warp{"big eyes", BigEyes},
    Warp{"long face", LongFace},
    Warp{"pear", Pear},
    Warp{"muzzle", Muzzle},
    Warp{"crooked", Crooked},
};

// A mapping with its memory, between neutrals of the 68 markers.
struct Context {
  std::vector<std::byte> block =
      std::vector<std::byte>(GeometryMapping::RequiredBytes(test::kMarkerCount));
  std::vector<std::byte> workspace =
      std::vector<std::byte>(GeometryMapping::WorkspaceBytes(test::kMarkerCount));
  MarkerPoints source = test::NeutralMarkers();
  GeometryMapping mapping;

  Context() {
    Arena arena(block);
    EXPECT_TRUE(mapping.Reserve(test::kMarkerCount, arena));
  }
  Result<> Solve(const MarkerPoints& target) {
    const std::vector<std::int16_t> nowhere(test::kMarkerCount, -1);
    return mapping.Solve(source, target, nowhere, workspace);
  }
};

struct Figures {
  double mapped = 0, copied = 0;  // mean error over mean motion
};

Figures Measure(const Warp& warp, float strength) {
  Context c;
  MarkerPoints target{};
  for (std::size_t i = 0; i < target.size(); ++i) target[i] = warp.at(c.source[i], strength);
  EXPECT_TRUE(c.Solve(target));
  double motion = 0;
  Figures sum;
  for (int frame = 0; frame < 2000; frame += 7) {
    const MarkerPoints now = test::PerformingMarkers(static_cast<float>(frame) / 100);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const Point3 truth = warp.at(now[i], strength) - target[i];
      motion += Length(truth);
      sum.mapped += Length(c.mapping.Motion(c.mapping.AnchorAt(c.source[i]), now[i]) - truth);
      sum.copied += Length(now[i] - c.source[i] - truth);
    }
  }
  return {sum.mapped / motion, sum.copied / motion};
}

TEST(GeometryMappingOfKnownWarps, IsWithinFifteenPercentAndBetterThanCopying) {
  for (const Warp& warp : kWarps) {
    const Figures figures = Measure(warp, 1);
    std::printf("%-26s error %4.1f %% of the motion, copying %4.1f %%\n", warp.name,
                100 * figures.mapped, 100 * figures.copied);
    EXPECT_LE(figures.mapped, 0.15) << warp.name;
    EXPECT_LT(figures.mapped, figures.copied) << warp.name;
  }
}

TEST(GeometryMappingOfKnownWarps, AStrongerWarpCostsAccuracyAndNeverMoreThanCopying) {
  for (const Warp& warp : {kWarps[1], kWarps[2], kWarps[4], kWarps[5]}) {
    for (const float strength : {0.1F, 0.5F, 2.0F, 3.0F}) {
      const Figures figures = Measure(warp, strength);
      std::printf("%-26s x %.1f: error %4.1f %%, copying %4.1f %%\n", warp.name, strength,
                  100 * figures.mapped, 100 * figures.copied);
      EXPECT_LT(figures.mapped, figures.copied) << warp.name << " " << strength;
      EXPECT_LE(figures.mapped, 0.2) << warp.name << " " << strength;
    }
  }
}

TEST(GeometryMappingOfKnownWarps, LidsThatCloseOnThePerformerCloseOnLargerEyes) {
  Context c;
  MarkerPoints target{};
  for (std::size_t i = 0; i < target.size(); ++i) target[i] = BigEyes(c.source[i], 1);
  ASSERT_TRUE(c.Solve(target));
  for (const auto& [upper, lower] : {std::pair{37, 41}, {38, 40}, {43, 47}, {44, 46}}) {
    const Point3 motion = c.mapping.Motion(c.mapping.AnchorAt(c.source[upper]), c.source[lower]);
    const float gap = target[upper].y - target[lower].y;
    EXPECT_NEAR(-motion.y / gap, 1, 0.06F) << "upper lid " << upper;
  }
}

TEST(GeometryMappingOfKnownWarps, LipsOfWhichTheCharactersStandApartMoveAsThePerformers) {
  Context c;
  MarkerPoints target = c.source;
  for (const std::size_t upper : {61, 62, 63}) target[upper].y += 0.15F;
  for (const std::size_t lower : {65, 66, 67}) target[lower].y -= 0.15F;
  ASSERT_TRUE(c.Solve(target));
  for (int frame = 0; frame < 2000; frame += 7) {
    const MarkerPoints now = test::PerformingMarkers(static_cast<float>(frame) / 100);
    for (std::size_t i = 60; i < test::kMarkerCount; ++i) {
      const Point3 motion = now[i] - c.source[i];
      const Point3 mapped = c.mapping.Motion(c.mapping.AnchorAt(c.source[i]), now[i]);
      EXPECT_LE(Length(mapped - motion), 0.2F * Length(motion) + 0.08F) << i;
    }
  }
}

// Whatever a character looks like: markers in any order, in one place, or scattered at random.
TEST(GeometryMappingOfContradictions, NeverMultipliesMotionNorTurnsItAround) {
  Context c;
  for (std::size_t trial = 0; trial < 20; ++trial) {
    MarkerPoints target = c.source;
    for (std::size_t i = 0; i < target.size(); ++i) {
      const std::size_t other = (i * (2 * trial + 3) + trial) % target.size();
      const Point3 from = trial % 2 == 0 ? c.source[other] : Point3{};
      target[i] = target[i] + (0.1F * static_cast<float>(trial)) * (from - target[i]);
    }
    ASSERT_TRUE(c.Solve(target));
    const std::vector<std::int16_t> nowhere(test::kMarkerCount, -1);
    const auto alignment = Align(c.source, target, nowhere);
    ASSERT_TRUE(alignment);
    for (int frame = 0; frame < 400; frame += 37) {
      const MarkerPoints now = test::PerformingMarkers(static_cast<float>(frame) / 100);
      for (std::size_t i = 0; i < now.size(); ++i) {
        const Point3 mapped = c.mapping.Motion(c.mapping.AnchorAt(c.source[i]), now[i]);
        const Point3 aligned = alignment->Motion(now[i] - c.source[i]);
        ASSERT_LE(Length(mapped), 1.001F * GeometryMapping::kMaxStretch * Length(aligned) + 1e-4F);
        ASSERT_GE(Dot(mapped, aligned), -1e-3F * Length(mapped) * Length(aligned) - 1e-6F);
      }
    }
  }
}

}  // namespace
}  // namespace facewire::retarget
