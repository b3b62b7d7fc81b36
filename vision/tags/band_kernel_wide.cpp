// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled for 256-bit vectors: nothing from other libraries may be instantiated here.
#include "vision/tags/band_kernel_body.h"

namespace fidservo::vision::kernel {

void add_band_wide(std::size_t geometry, const Band& band, const Constants& constants, Residuals* residuals,
                   Sums& sums) {
    add_band(geometry, band, constants, residuals, sums);
}

void add_scatter_wide(std::size_t geometry, const Band& band, const Constants& constants, Sums& sums) {
    add_scatter(geometry, band, constants, sums);
}

bool has_wide_vectors() {
#ifdef __AVX2__
    return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
#else
    return false;
#endif
}

}  // namespace fidservo::vision::kernel
