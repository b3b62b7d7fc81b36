// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/preisach.h"

namespace fidservo {

/// First-order descending curves of a wire that nobody has measured yet. Heated, it contracts along a
/// logistic curve,
///
///     h(T) = stroke / (1 + exp(-(T - 79 degC) / 4.5 degC)),
///
/// and its domains relax w degC below the temperature at which they contracted, w spread evenly from 15 to
/// 35 degC:
///
///     f(a, b) = mean over w of h(min(a, b + w)).
///
/// Centre, slope and widths are about those of the published stage's wire. Grid: 10 to 120 degC in steps
/// of 2.
FodTable generic_fod(double stroke_mm);

}  // namespace fidservo
