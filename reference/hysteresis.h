// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The wire's contraction as a function of its temperature, by one of two laws of hysteresis.
#include "reference/departures.h"
#include "reference/duhem.h"
#include "reference/preisach_plane.h"

#include <variant>

namespace fidservo::reference {

/// A load raises the transformation temperatures: the law is evaluated at temperature - shift, part of which
/// may depend on the contraction x. The law's contraction is multiplied by 1 + (stroke - 1) (1 - fading x).
/// Immutable.
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
