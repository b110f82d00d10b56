#ifndef FACEWIRE_CORE_RBF_MATRIX_PRODUCT_H_
#define FACEWIRE_CORE_RBF_MATRIX_PRODUCT_H_

#include <cstddef>

namespace facewire::rbf {

// A part of a larger matrix that lies in memory by rows: element (r, c) is at[r * stride + c].
struct Block {
  double* at = nullptr;
  std::size_t stride = 0;
};

// C += scale * A * B with A rows x inner, B inner x columns, C rows x columns. C overlaps neither A
// nor B. Nearly all the time of a factorisation is spent here, so it works in tiles that stay in
// registers and in the first cache. No allocation.
void AddProduct(double scale, Block a, Block b, Block c, std::size_t rows, std::size_t inner,
                std::size_t columns) noexcept;

}  // namespace facewire::rbf

#endif  // FACEWIRE_CORE_RBF_MATRIX_PRODUCT_H_
