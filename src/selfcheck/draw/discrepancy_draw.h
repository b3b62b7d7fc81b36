// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Discrepancies that no effect of the catalogue describes: smooth functions of random shape that act on one
// block of the signal chain.
#include "core/random.h"
#include "core/rig.h"
#include "reference/departures.h"

#include <span>
#include <string_view>

namespace fidservo::selfcheck {

/// Where a discrepancy acts, and the quantity on which it depends.
struct DiscrepancyKind {
    std::string_view block, depends_on;
    reference::ActsOn acts_on;
    reference::DependsOn variable;
    double start_size;  ///< r.m.s. from which the search for a size of some floors starts, V or mm
    double largest;     ///< largest size, in the same unit
};

std::span<const DiscrepancyKind> discrepancy_kinds();

/// Draws a discrepancy. Its correlation length is between a twelfth and a quarter of the variable's range in
/// the campaign, so that no straight line, cubic or single sine wave approximates it.
/// @param rig  with a micro stage
reference::Discrepancy draw_discrepancy(const DiscrepancyKind& kind, const Rig& rig, double size,
                                        NoiseStream& draw);

}  // namespace fidservo::selfcheck
