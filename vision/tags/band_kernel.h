// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The inner loop of the refinement: what a band of pixels along a tag's edges should look like
// (band_model.h), its derivatives, and their products, summed. Plain data in and out, so that it can be
// compiled for several kinds of processor.
#include "vision/tags/lanes.h"

#include <cstddef>

namespace fidservo::vision::kernel {

/// The neighbourhood of one crossing of the code's grid lines, half a cell to each side. Coverage by white is
/// there, with the profiles A(x) and B(y) of the two lines,
///
///     c + cx A + cy B + cxy A B
struct Node {
    std::size_t first_block, last_block;  ///< last: one after
    float x, y;                           ///< tag frame
    float px_per_cell_x;                  ///< distance in the image from the line x = const, per cell
    float px_per_cell_y;
    float c, cx, cy, cxy;
    float edge_up, edge_down;     ///< 1 where the line x = const parts black from white, above and below
    float edge_left, edge_right;  ///< likewise y = const
    float corners;  ///< cells whose corner stands out here: white ones less black ones; 2 where cells meet
                    ///< crosswise
};

/// Which of a crossing's lines pixels are near. Of the other one they see only on which side they are.
enum class Near { both, line_x, line_y };

/// Pixels that are judged and weighted together, at most.
inline constexpr std::size_t block = 32;

struct Block {
    std::size_t begin;   ///< of its pixels in the band; a multiple of lane_count
    std::size_t pixels;  ///< those that fill up to a multiple are not counted
    Near near;
    float far_level;  ///< profile of the line that is not near: 0 or 1
};

/// Pixels: their place (TagPicture::Cubic's U and V) and grey level; blocks with square roots of weights.
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
    float cubic_x[10], cubic_y[10];        ///< from (U, V) to the tag frame, for 4 geometry parameters
    float homography[9];                   ///< the same for 8, row by row
    float inverse_blur_x, inverse_blur_y;  ///< 1 / px
    float half_motion_x, half_motion_y;    ///< in standard deviations of the blur
    float spread, skew, tail, kink;
    float black, height;
    float light_x, light_y, light_r;  ///< per cell, per cell squared
    float noise_floor, noise_gain, noise_spread;
};

/// Parameters after the geometry's, in the order of the columns; the residual's column follows.
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

/// What the model leaves of a block's pixels, in standard deviations of the noise, without weights.
struct Residuals {
    float sum;
    float square_sum;
};

struct Sums {
    double products[most_columns][most_columns];  ///< of columns; on and below the diagonal
};

/// @param geometry  4 or 8 parameters
/// @param residuals  is filled with each block's; may be null, and blocks of weight 0 are passed over then
using AddBand = void (*)(std::size_t geometry, const Band& band, const Constants& constants,
                         Residuals* residuals, Sums& sums);
/// Outer products of every crossing's sums of column times residual, added up.
using AddScatter = void (*)(std::size_t geometry, const Band& band, const Constants& constants, Sums& sums);

void add_band_plain(std::size_t, const Band&, const Constants&, Residuals*, Sums&);
void add_scatter_plain(std::size_t, const Band&, const Constants&, Sums&);
/// For processors with 256-bit vectors and fused multiplication; only where has_wide_vectors().
void add_band_wide(std::size_t, const Band&, const Constants&, Residuals*, Sums&);
void add_scatter_wide(std::size_t, const Band&, const Constants&, Sums&);
bool has_wide_vectors();

}  // namespace fidservo::vision::kernel
