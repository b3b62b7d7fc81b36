// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Outlier rejection: the parts of a band that do not look like the tag, because they are covered, scratched
// or overexposed by glare.
#include "vision/tags/edge_band.h"

#include <vector>

namespace fidservo::vision {

struct BlockJudgement {
    std::vector<float> excess;  ///< for every block; a block with more than 1 does not look like the tag
    float usual = 1.0F;         ///< mean squared residual of a typical block that fits
};

/// Judges every block by itself and every crossing as a whole. Residuals are scaled by the mean square of the
/// usual block, so that a model that fits imperfectly everywhere does not lead to rejections. A block's mean
/// square may exceed the usual one by 4.4 standard deviations, a crossing's by 3.6: with more pixels, a
/// crossing reveals disturbances that are too faint for a single block.
/// @param allowance  mean square of a block for which the model is right: 1 for noise alone, more if
/// rounding, whose errors are correlated between neighbouring pixels, is a large part of the noise
/// @param residuals  of the blocks (band_model.h)
/// @param judgement  receives the result
void judge_blocks(const EdgeBand& band, float allowance, const std::vector<kernel::Residuals>& residuals,
                  BlockJudgement& judgement);

/// Extends the rejected parts to their surroundings, since glare and shadow fade out gradually, and a part
/// that is too faint for judge_blocks() still shifts the tag's position:
/// - A crossing is damaged if a block along one of its edges does not fit. (Blocks at the crossing itself do
///   not count: they are the first to misfit where print or camera deviate from the model.)
/// - At and beside a damaged crossing, an edge or crossing is left out as a whole if a block of it does not
///   fit, or if the sum of its residuals exceeds 3 standard deviations: a disturbance of light has one sign,
///   and a sum detects disturbances a third as large as a mean square does.
/// - If an edge is left out, so is the crossing from which it starts; if a crossing is left out, so are all
///   of its edges, even if they fit: if noise decided about the faintest ones, the tag's position would
///   scatter more than its stated uncertainty.
/// @param judgement  the result of judge_blocks(); blocks left out in addition have an excess above 1
///                   afterwards
void follow_damage(const EdgeBand& band, const std::vector<kernel::Residuals>& residuals,
                   BlockJudgement& judgement);

}  // namespace fidservo::vision
