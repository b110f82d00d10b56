#include "core/track/custom_options.h"

#include <flatbuffers/flexbuffers.h>

#include <algorithm>
#include <array>

namespace facewire::track {
namespace {

// The networks' own options take 251 bytes at most.
constexpr std::size_t kMaxBytes = 2048;

bool IsMeshPoint(std::int64_t index) noexcept {
  return index >= 0 && index < static_cast<std::int64_t>(kMeshLandmarks);
}

bool IsGoodScale(float scale) noexcept { return scale > 0.1F && scale < 10.0F; }

}  // namespace

Result<PartOptions> ReadPartOptions(std::span<const std::byte> flexbuffer) noexcept {
  // A flexbuffer reads its numbers in place, so they must lie aligned; inside a file they need not.
  alignas(8) std::array<std::uint8_t, kMaxBytes> bytes;
  if (flexbuffer.size() < 3 || flexbuffer.size() > bytes.size()) return Errc::kCorrupt;
  std::transform(flexbuffer.begin(), flexbuffer.end(), bytes.begin(),
                 [](std::byte b) { return static_cast<std::uint8_t>(b); });
  if (!flexbuffers::VerifyBuffer(bytes.data(), flexbuffer.size())) return Errc::kCorrupt;
  const flexbuffers::Reference root = flexbuffers::GetRoot(bytes.data(), flexbuffer.size());
  if (!root.IsMap()) return Errc::kCorrupt;

  const flexbuffers::Map map = root.AsMap();
  PartOptions options;
  const std::int64_t left = map["left_rotation_idx"].AsInt64();
  const std::int64_t right = map["right_rotation_idx"].AsInt64();
  const std::int64_t width = map["output_width"].AsInt64();
  const std::int64_t height = map["output_height"].AsInt64();
  if (!IsMeshPoint(left) || !IsMeshPoint(right)) return Errc::kCorrupt;
  if (width < 1 || width > 64 || height < 1 || height > 64) return Errc::kCorrupt;
  options.left_rotation = static_cast<int>(left);
  options.right_rotation = static_cast<int>(right);
  options.output_width = static_cast<int>(width);
  options.output_height = static_cast<int>(height);
  options.scale_x = map["scale_x"].AsFloat();
  options.scale_y = map["scale_y"].AsFloat();
  if (!IsGoodScale(options.scale_x) || !IsGoodScale(options.scale_y)) return Errc::kCorrupt;

  if (!map["subset_idxs"].IsTypedVector()) return Errc::kCorrupt;
  const flexbuffers::TypedVector subset = map["subset_idxs"].AsTypedVector();
  for (std::size_t i = 0; i < subset.size(); ++i) {
    const std::int64_t index = subset[i].AsInt64();
    if (!IsMeshPoint(index)) return Errc::kCorrupt;
    if (!options.subset.try_push(static_cast<std::uint16_t>(index))) return Errc::kCorrupt;
  }
  if (options.subset.empty()) return Errc::kCorrupt;
  return options;
}

}  // namespace facewire::track
