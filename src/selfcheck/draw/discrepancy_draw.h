// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Discrepancies that no effect has: smooth functions of random shape on one signal's block.
#include "core/random.h"
#include "core/rig.h"
#include "reference/departures.h"

#include <span>
#include <string_view>

namespace fidservo::selfcheck {

/// A place where a discrepancy may act, and what it depends on.
struct DiscrepancyKind {
    std::string_view block, depends_on;
    reference::ActsOn acts_on;
    reference::DependsOn variable;
    double start_size;  ///< r.m.s. from which the search for a size of some floors begins: V, or mm
    double largest;     ///< in the same unit
};

std::span<const DiscrepancyKind> discrepancy_kinds();

/// Its correlation length is drawn from a twelfth to a quarter of the range that the campaign covers, so that
/// no straight line, cubic or single wave follows it.
/// @param rig  with a micro stage
reference::Discrepancy draw_discrepancy(const DiscrepancyKind& kind, const Rig& rig, double size,
                                        NoiseStream& draw);

}  // namespace fidservo::selfcheck
