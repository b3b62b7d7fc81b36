#pragma once
// Which parts of a band do not look like the tag: covered, scratched, glaring.
#include "vision/edge_band.h"

#include <vector>

namespace fidservo::vision {

/// For every block, its mean squared residual over what noise allows: above 1 it does not look like the tag.
/// The scale is the usual block's, so that a model which fits nowhere perfectly rejects nothing for that. A
/// block is allowed 4.4 standard deviations. A crossing is judged as a whole too, with 3.6, as it shows what
/// is too faint to be seen in a block; and with 1.9 beside a crossing that does not fit, where the edge of a
/// shadow or a glare runs out.
/// @param allowance  mean square that a block may have where the model is right: 1 for noise alone, more
///                   where rounding, which neighbours have in common, is much of it
/// @param block_squares  sums of squared residuals in variances of the noise (band_model.h)
/// @param excess  is filled
void judge_blocks(const EdgeBand& band, float allowance, const std::vector<float>& block_squares,
                  std::vector<float>& excess);

}  // namespace fidservo::vision
