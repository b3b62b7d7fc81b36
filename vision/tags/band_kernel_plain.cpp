// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/band_kernel_body.h"

namespace fidservo::vision::kernel {

void add_band_plain(std::size_t geometry, const Band& band, const Constants& constants, Residuals* residuals,
                    Sums& sums) {
    add_band(geometry, band, constants, residuals, sums);
}

void add_scatter_plain(std::size_t geometry, const Band& band, const Constants& constants, Sums& sums) {
    add_scatter(geometry, band, constants, sums);
}

}  // namespace fidservo::vision::kernel
