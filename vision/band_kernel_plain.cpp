#include "vision/band_kernel_body.h"

namespace fidservo::vision::kernel {

void add_band_plain(std::size_t geometry, const Band& band, const Constants& constants, float* block_squares,
                    Sums& sums) {
    add_band(geometry, band, constants, block_squares, sums);
}

void add_scatter_plain(std::size_t geometry, const Band& band, const Constants& constants, Sums& sums) {
    add_scatter(geometry, band, constants, sums);
}

}  // namespace fidservo::vision::kernel
