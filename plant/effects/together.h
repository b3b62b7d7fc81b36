// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A rig file states an effect once. What is found beside what it states is to be stated as one with it.
#include "plant/effects/effect.h"

namespace fidservo {
struct StatedEffect;
}

namespace fidservo::plant {

/// What changes a plant as two statements of one effect do, put into it one after the other (Effect::again).
/// Parameters that the second one does not give are those of the first. Of coulomb_friction's share of the
/// dead zone, which acts in two ways, it is the sum. Throws InputError where the two together are out of
/// bounds, and like setting_of().
/// @param stated, beside  of one effect of the catalogue
StatedEffect together(const StatedEffect& stated, const StatedEffect& beside);

}  // namespace fidservo::plant
