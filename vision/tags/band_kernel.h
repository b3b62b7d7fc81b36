// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The inner loop of the tag refinement: the modelled grey levels of a band of pixels along a tag's edges
// (band_model.h), their derivatives, and the sums of their products for the normal equations. Only plain data
// are passed, so that it can be compiled for several kinds of processor.
#include "vision/tags/lanes.h"

#include <cstddef>

namespace fidservo::vision::kernel {

/// The neighbourhood of one crossing of the code's grid lines, half a cell to each side. With the edge
/// profiles A(x) and B(y) of the two lines, the fraction of white at a point of it is
///
///     c + cx A + cy B + cxy A B
struct Node {
    std::size_t first_block, last_block;  ///< the crossing's blocks; last_block is one past the end
    float x, y;                           ///< place of the crossing in the tag frame
    float px_per_cell_x;                  ///< distance in the image from the line x = const, px per cell
    float px_per_cell_y;
    float c, cx, cy, cxy;
    /// 1 if the line x = const separates black from white above (below) the crossing, otherwise 0.
    float edge_up, edge_down;
    float edge_left, edge_right;  ///< the same for the line y = const, left and right of the crossing
    /// Number of white cells whose corner projects here less that of black ones; 2 where cells touch
    /// diagonally.
    float corners;
};

/// Which of a crossing's two lines is within reach of the block's pixels. The profile of the other line is
/// constant there, 0 or 1 (Block::far_level).
enum class Near { both, line_x, line_y };

/// Largest number of pixels that are judged and weighted together.
inline constexpr std::size_t block = 32;

struct Block {
    std::size_t begin;   ///< index of its first pixel in the band; a multiple of lane_count
    std::size_t pixels;  ///< number of its pixels, without the padding to a multiple of lane_count
    Near near;
    float far_level;  ///< value of the profile of the line that is not near: 0 or 1
};

/// The pixels: coordinates (U and V of TagPicture::Cubic) and grey levels. The weights of the blocks are
/// given as square roots.
struct Band {
    const float* u;
    const float* v;
    const float* grey;
    const Block* blocks;
    const float* weights;
    const Node* nodes;
    std::size_t node_count;
};

struct Constants {
    float cubic_x[10], cubic_y[10];  ///< from (U, V) to the tag frame, with 4 geometry parameters
    float homography[9];             ///< from (U, V) to the tag frame, with 8 geometry parameters; row by row
    float inverse_blur_x, inverse_blur_y;  ///< 1 / px
    /// Half the motion during the exposure, in standard deviations of the blur.
    float half_motion_x, half_motion_y;
    float spread, skew, tail, kink;
    float black, height;
    float light_x, light_y, light_r;  ///< gradients of light, per cell, and its radial term, per cell squared
    float noise_floor, noise_gain, noise_spread;
};

/// The parameters that follow those of the geometry, in the order of the columns; the residual's column comes
/// last.
enum LookColumn {
    width_x,
    width_y,
    spread,
    skew,
    tail,
    kink,
    white,
    black,
    light_x,
    light_y,
    light_r,
    look_columns
};

constexpr std::size_t columns_of(std::size_t geometry) {
    return (geometry + look_columns + 1 + 3) / 4 * 4;
}
inline constexpr std::size_t most_columns = columns_of(8);
inline constexpr double half_side_cells = 4.0;

/// The residuals of a block's pixels in standard deviations of the noise, without weights.
struct Residuals {
    float sum;
    float square_sum;
};

struct Sums {
    /// Sums of products of two columns; on and below the diagonal.
    double products[most_columns][most_columns];
};

/// @param geometry  number of geometry parameters, 4 or 8
/// @param residuals  receives each block's residuals; may be null, and then blocks of weight 0 are skipped
using AddBand = void (*)(std::size_t geometry, const Band& band, const Constants& constants,
                         Residuals* residuals, Sums& sums);
/// Adds, for every crossing, the outer product s s^T to the sums, with s the sum of columns times residual
/// over its pixels.
using AddScatter = void (*)(std::size_t geometry, const Band& band, const Constants& constants, Sums& sums);

void add_band_plain(std::size_t, const Band&, const Constants&, Residuals*, Sums&);
void add_scatter_plain(std::size_t, const Band&, const Constants&, Sums&);
/// For processors with 256-bit vectors and fused multiply-add; may be called only if has_wide_vectors().
void add_band_wide(std::size_t, const Band&, const Constants&, Residuals*, Sums&);
void add_scatter_wide(std::size_t, const Band&, const Constants&, Sums&);
bool has_wide_vectors();

}  // namespace fidservo::vision::kernel
