// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which parts of a band do not look like the tag: covered, scratched, glaring.
#include "vision/tags/edge_band.h"

#include <vector>

namespace fidservo::vision {

struct BlockJudgement {
    std::vector<float> excess;  ///< of every block: above 1 it does not look like the tag
    float usual = 1.0F;         ///< mean squared residual of a block that fits as well as any
};

/// Judges every block by itself and every crossing. The scale is the usual block's mean squared residual, so
/// that a model which fits nowhere perfectly rejects nothing for that. A block's mean square is allowed 4.4
/// standard deviations; a crossing's 3.6, as it shows what is too faint to be seen in a block.
/// @param allowance  mean square that a block may have where the model is right: 1 for noise alone, more
///                   where rounding, which neighbours have in common, is much of it
/// @param residuals  of the blocks (band_model.h)
/// @param judgement  is filled
void judge_blocks(const EdgeBand& band, float allowance, const std::vector<kernel::Residuals>& residuals,
                  BlockJudgement& judgement);

/// Glare and shadow end gradually. What is too faint for judge_blocks still shifts the tag, so damage is
/// followed:
/// - A crossing is damaged if a block along one of its edges does not fit. (Where lines meet, prints and
///   cameras that are not as the model believes them misfit first.)
/// - At and beside a damaged crossing, an edge or crossing is left out as a whole if a block of it does not
///   fit, or if the sum of its residuals exceeds 3 standard deviations: light that is added or taken away
///   has one sign, and a sum sees a third of what a mean square sees.
/// - With an edge goes the crossing that it leaves, with a crossing go all its edges, however well they fit:
///   if noise alone decided about the faintest, the tag's place would scatter more than is claimed for it.
/// @param judgement  by judge_blocks; what is left out in addition exceeds 1 afterwards
void follow_damage(const EdgeBand& band, const std::vector<kernel::Residuals>& residuals,
                   BlockJudgement& judgement);

}  // namespace fidservo::vision
