#ifndef FACEWIRE_CORE_BASE_CAPACITY_H_
#define FACEWIRE_CORE_BASE_CAPACITY_H_

#include <cstddef>

// Every fixed capacity of facewire, in one place. Raising one costs memory only; `facewired
// --memory` prints what.
namespace facewire {

inline constexpr std::size_t kMaxLandmarks = 478;  // attention network: 468 mesh, 2 x 5 iris
inline constexpr std::size_t kMeshLandmarks = 468;
inline constexpr std::size_t kMaxBones = 80;       // one for each of the usual 68 markers, and some
inline constexpr std::size_t kMaxChannels = 240;   // values in one RigPose: three for each bone
inline constexpr std::size_t kMaxDrives = 8;       // signals that add up to one channel
inline constexpr std::size_t kMaxCurvePoints = 8;  // of the response of one channel
inline constexpr std::size_t kMaxSignals = 96;     // outputs of the expression mapping
inline constexpr std::size_t kMaxExpressionInputs = 384;  // 3 x landmarks that a profile reads
inline constexpr std::size_t kMaxMarkers = kMaxExpressionInputs / 3;
inline constexpr std::size_t kMaxTrainingSamples = 1024;
inline constexpr std::size_t kMaxRegions = 16;         // of the face, in one profile
inline constexpr std::size_t kMaxRegionGaps = 32;      // between two markers, in one region
inline constexpr std::size_t kMaxNeutralFrames = 128;  // of which a neutral is the median
inline constexpr std::size_t kMaxServos = 64;          // of one rig, all buses together
inline constexpr std::size_t kMaxNameLength = 31;
inline constexpr std::size_t kMaxWirePayload = 1024;  // bytes of one message before COBS

}  // namespace facewire

#endif  // FACEWIRE_CORE_BASE_CAPACITY_H_
