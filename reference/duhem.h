// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A Duhem model of the wire's hysteresis with the same major loop as the Preisach table; the present
// contraction is its only memory. With the major loop's heating branch U(T) and cooling branch D(T), full
// stroke S and rest contraction x0,
//
//     heating:  dx/dT = U'(T) (S - x) / (S - U(T)),     cooling:  dx/dT = D'(T) (x - x0) / (D(T) - x0)
//
// From saturation it runs along the major loop; inside, the share of the wire yet to transform follows the
// branch's kinetics (as Liang and Rogers have it for shape-memory alloys). In both the ratio on the right
// stays constant, which gives them in closed form. Its minor loops neither close nor are congruent, unlike
// those of Preisach's model. Source: Visintin, "Differential Models of Hysteresis", Springer, 1994, chapter
// V; Liang, Rogers, "One-dimensional thermomechanical constitutive relations for shape memory materials", J.
// Intell. Mater. Syst. Struct. 1 (1990).
#include "core/preisach.h"

#include <vector>

namespace fidservo::reference {

/// The branches of the major loop at the table's temperatures, linearly interpolated.
struct DuhemLaw {
    double low_degC, step_degC;
    std::vector<double> heating_mm, cooling_mm;
};

struct DuhemState {
    double temp_degC;
    double contraction_mm;
};

DuhemLaw make_duhem(const FodTable& table);

/// The state after heating from negative saturation.
DuhemState heated_to(const DuhemLaw& law, double temp_degC);

/// Moves monotonically to a temperature, which is clamped to the table's range.
void move_to(const DuhemLaw& law, DuhemState& state, double temp_degC);

}  // namespace fidservo::reference
