#ifndef FACEWIRE_TOOLS_FACEWIRE_RIG_CANONICAL_MESH_H_
#define FACEWIRE_TOOLS_FACEWIRE_RIG_CANONICAL_MESH_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/base/capacity.h"
#include "core/base/geometry.h"

namespace facewire::tools::rig {

// Every landmark of the face mesh on MediaPipe's canonical face, in the head frame of FacePose, cm.
extern const std::array<Point3, kMeshLandmarks> kCanonicalMesh;

// Where its eyeballs turn, an average of people's; left and right are the person's own.
inline constexpr Point3 kCanonicalLeftEye{3.18F, 2.6F, 2.6F};
inline constexpr Point3 kCanonicalRightEye{-3.18F, 2.6F, 2.6F};
inline constexpr std::int16_t kLeftIris = 473;
inline constexpr std::int16_t kRightIris = 468;

struct NearLandmark {
  std::int16_t index = -1;
  std::string_view name;  // of app/rig_file.h; empty: a landmark without one
  float distance_cm = 0;
};

// The landmark that lies nearest to a place on the canonical face and is not among `taken`: one
// that has a name if it is within a centimetre, else any within two; else nullopt.
std::optional<NearLandmark> NearestLandmark(Point3 place, std::span<const std::int16_t> taken);

// The name of the named landmark that is nearest to a place, however far it is.
std::string_view NearestName(Point3 place);

}  // namespace facewire::tools::rig

#endif  // FACEWIRE_TOOLS_FACEWIRE_RIG_CANONICAL_MESH_H_
