// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Another law for the wire's hysteresis on the same major loop: of Duhem's kind, with the present contraction
// as its only memory. With the major loop's heating branch U(T) and cooling branch D(T), full stroke S and
// rest contraction x0,
//
//     heating:  dx/dT = U'(T) (S - x) / (S - U(T)),     cooling:  dx/dT = D'(T) (x - x0) / (D(T) - x0)
//
// From saturation it runs along the major loop; inside, the share of the wire yet to transform follows the
// branch's kinetics (as Liang and Rogers have it for shape-memory alloys). Both have the integral that the
// ratio on the right stays constant. Minor loops neither close nor are they congruent: that is where it
// departs from Preisach's law.
// Source: Visintin, "Differential Models of Hysteresis", Springer, 1994, chapter V; Liang, Rogers, "One-
// dimensional thermomechanical constitutive relations for shape memory materials", J. Intell. Mater. Syst.
// Struct. 1 (1990).
#include "core/preisach.h"

#include <vector>

namespace fidservo::reference {

/// The branches of the major loop at the table's temperatures, linear between them.
struct DuhemLaw {
    double low_degC, step_degC;
    std::vector<double> heating_mm, cooling_mm;
};

struct DuhemState {
    double temp_degC;
    double contraction_mm;
};

DuhemLaw make_duhem(const FodTable& table);

/// After heating from negative saturation.
DuhemState heated_to(const DuhemLaw& law, double temp_degC);

/// Moves the temperature, clamped to the table's range, monotonically.
void move_to(const DuhemLaw& law, DuhemState& state, double temp_degC);

}  // namespace fidservo::reference
