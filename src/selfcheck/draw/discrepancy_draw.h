// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Discrepancies that are no effect of the catalogue: smooth functions of random shape on one signal's block.
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
    double start_size;  ///< r.m.s. at which the search for a size of some floors begins: V, or mm
    double largest;     ///< largest size, in the same unit
};

std::span<const DiscrepancyKind> discrepancy_kinds();

/// Draws a discrepancy. Its correlation length is between a twelfth and a quarter of the range that the
/// campaign covers, so that no line, cubic or single wave approximates it.
/// @param rig  with a micro stage
reference::Discrepancy draw_discrepancy(const DiscrepancyKind& kind, const Rig& rig, double size,
                                        NoiseStream& draw);

}  // namespace fidservo::selfcheck
