// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The signal chain as a drawing: blocks, the measured boundaries between them with the gap at each, and
// which blocks are accused.
#include "gap/diagnosis.h"

#include <string>

namespace fidservo {
struct Rig;
}

namespace fidservo::diagnose {

/// An SVG of the parts that the rig has. A block's class is "block accused" from a probability of 0.5 on and
/// "block suspect" from 0.05 on; a boundary's "boundary size-0" .. "size-4" by the gap there.
std::string chain_drawing_svg(const Rig& rig, const gap::Diagnosis& diagnosis);

}  // namespace fidservo::diagnose
