#include "core/track/attention_ops.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace facewire::track {

CutTransform PartTransform(const PartOptions& options, std::span<const float> mesh,
                           float scale) noexcept {
  const auto x = [&](int i) { return scale * mesh[3 * static_cast<std::size_t>(i)]; };
  const auto y = [&](int i) { return scale * mesh[3 * static_cast<std::size_t>(i) + 1]; };
  const float dx = x(options.right_rotation) - x(options.left_rotation);
  const float dy = y(options.right_rotation) - y(options.left_rotation);
  const float length = std::hypot(dx, dy);
  // As in the original, points that lie exactly level or on top of each other count as upright.
  const bool upright = dx == 0.0F || dy == 0.0F;
  const float c = upright ? 1.0F : dx / length;
  const float s = upright ? 0.0F : dy / length;

  // The box around the subset, in axes turned with the part.
  float min_u = INFINITY, max_u = -INFINITY, min_v = INFINITY, max_v = -INFINITY;
  for (const std::uint16_t i : options.subset) {
    const float u = c * x(i) + s * y(i);
    const float v = c * y(i) - s * x(i);
    min_u = std::min(min_u, u);
    max_u = std::max(max_u, u);
    min_v = std::min(min_v, v);
    max_v = std::max(max_v, v);
  }
  const float mid_u = 0.5F * (min_u + max_u);
  const float mid_v = 0.5F * (min_v + max_v);
  const auto width = static_cast<float>(options.output_width);
  const auto height = static_cast<float>(options.output_height);
  const float step_u = options.scale_x * (max_u - min_u) / width;
  const float step_v = options.scale_y * (max_v - min_v) / height;
  const float left = mid_u - 0.5F * width * step_u;
  const float top = mid_v - 0.5F * height * step_v;
  return {.xx = c * step_u,
          .xy = -s * step_v,
          .x0 = c * left - s * top,
          .yx = s * step_u,
          .yy = c * step_v,
          .y0 = s * left + c * top};
}

void CutFeatures(const FeatureMap& map, const CutTransform& t, int cut_width, int cut_height,
                 std::span<float> cut) noexcept {
  const auto channels = static_cast<std::size_t>(map.channels);
  const auto max_x = static_cast<float>(map.width - 1);
  const auto max_y = static_cast<float>(map.height - 1);
  float* __restrict out = cut.data();
  for (int row = 0; row < cut_height; ++row) {
    for (int column = 0; column < cut_width; ++column, out += channels) {
      const float u = static_cast<float>(column) + 0.5F;
      const float v = static_cast<float>(row) + 0.5F;
      const float x = t.xx * u + t.xy * v + t.x0 - 0.5F;
      const float y = t.yx * u + t.yy * v + t.y0 - 0.5F;
      // Written so that NaN, too, is outside.
      if (!(x >= 0.0F && x <= max_x && y >= 0.0F && y <= max_y)) {
        std::fill_n(out, channels, 0.0F);
        continue;
      }
      const int x0 = std::min(static_cast<int>(x), map.width - 2);
      const int y0 = std::min(static_cast<int>(y), map.height - 2);
      const float fx = x - static_cast<float>(x0);
      const float fy = y - static_cast<float>(y0);
      const float* __restrict top =
          map.values.data() + (static_cast<std::size_t>(y0) * map.width + x0) * channels;
      const float* __restrict bottom = top + static_cast<std::size_t>(map.width) * channels;
      for (std::size_t k = 0; k < channels; ++k) {
        const float upper = top[k] + fx * (top[k + channels] - top[k]);
        const float lower = bottom[k] + fx * (bottom[k + channels] - bottom[k]);
        out[k] = upper + fy * (lower - upper);
      }
    }
  }
}

}  // namespace facewire::track
