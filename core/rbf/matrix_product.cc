#include "core/rbf/matrix_product.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace facewire::rbf {
namespace {

// Two doubles in one vector register (NEON, SSE2); written out because GCC does not keep an array
// of sums in registers by itself.
using Pair = double __attribute__((vector_size(16)));
constexpr std::size_t kTileRows = 4;
constexpr std::size_t kTileColumns = 4;
// Rows of B that are copied together: with its columns 3 kB of the first cache, whatever the
// distance between B's rows in memory.
constexpr std::size_t kInner = 96;

using Packed = std::array<double, kInner * kTileColumns>;

// scale * B's tile, by rows, columns beyond `columns` as zeros.
void Pack(double scale, Block b, std::size_t inner, std::size_t columns, Packed& packed) noexcept {
  for (std::size_t k = 0; k < inner; ++k)
    for (std::size_t c = 0; c < kTileColumns; ++c)
      packed[k * kTileColumns + c] = c < columns ? scale * b.at[k * b.stride + c] : 0.0;
}

// Sums of one full tile, by rows.
void TileProduct(Block a, const double* __restrict b, std::size_t inner,
                 double* __restrict sums) noexcept {
  std::array<Pair, kTileRows> left{};
  std::array<Pair, kTileRows> right{};
  for (std::size_t k = 0; k < inner; ++k) {
    Pair b_left;
    Pair b_right;
    std::memcpy(&b_left, b + k * kTileColumns, sizeof(Pair));
    std::memcpy(&b_right, b + k * kTileColumns + 2, sizeof(Pair));
    for (std::size_t r = 0; r < kTileRows; ++r) {
      left[r] += a.at[r * a.stride + k] * b_left;
      right[r] += a.at[r * a.stride + k] * b_right;
    }
  }
  for (std::size_t r = 0; r < kTileRows; ++r) {
    std::memcpy(sums + r * kTileColumns, &left[r], sizeof(Pair));
    std::memcpy(sums + r * kTileColumns + 2, &right[r], sizeof(Pair));
  }
}

}  // namespace

void AddProduct(double scale, Block a, Block b, Block c, std::size_t rows, std::size_t inner,
                std::size_t columns) noexcept {
  Packed packed;
  for (std::size_t k = 0; k < inner; k += kInner) {
    const std::size_t depth = std::min(kInner, inner - k);
    for (std::size_t column = 0; column < columns; column += kTileColumns) {
      const std::size_t width = std::min(kTileColumns, columns - column);
      Pack(scale, {b.at + k * b.stride + column, b.stride}, depth, width, packed);
      for (std::size_t row = 0; row < rows; row += kTileRows) {
        const Block tile = {a.at + row * a.stride + k, a.stride};
        double* out = c.at + row * c.stride + column;
        const std::size_t height = std::min(kTileRows, rows - row);
        if (height == kTileRows) {
          std::array<double, kTileRows * kTileColumns> sums;
          TileProduct(tile, packed.data(), depth, sums.data());
          for (std::size_t r = 0; r < kTileRows; ++r)
            for (std::size_t i = 0; i < width; ++i)
              out[r * c.stride + i] += sums[r * kTileColumns + i];
          continue;
        }
        for (std::size_t r = 0; r < height; ++r)
          for (std::size_t i = 0; i < width; ++i) {
            double sum = 0;
            for (std::size_t d = 0; d < depth; ++d)
              sum += tile.at[r * a.stride + d] * packed[d * kTileColumns + i];
            out[r * c.stride + i] += sum;
          }
      }
    }
  }
}

}  // namespace facewire::rbf
