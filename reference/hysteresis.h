// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From the wire's temperature to its contraction, by the law chosen.
#include "reference/departures.h"
#include "reference/duhem.h"
#include "reference/preisach_plane.h"

#include <variant>

namespace fidservo::reference {

/// A load moves the transformation temperatures: the law sees temperature - shift, of which a part may go
/// with the contraction x. What it gives is multiplied by 1 + (stroke - 1) (1 - fading x). Immutable.
struct HysteresisModel {
    std::variant<PreisachPlane, DuhemLaw> law;
    double shift_degC;
    double shift_degC_per_mm;
    double shift_degC_per_mm2;
    double stroke;
    double stroke_fading_per_mm;
};

using HysteresisState = std::variant<Staircase, DuhemState>;

HysteresisModel make_hysteresis(const FodTable& table, const HysteresisDepartures& departures);

/// A wire that was heated from negative saturation to a temperature.
HysteresisState heated_to(const HysteresisModel& model, double temp_degC);

void move_to(const HysteresisModel& model, HysteresisState& state, double temp_degC);

double contraction_mm(const HysteresisModel& model, const HysteresisState& state);

}  // namespace fidservo::reference
