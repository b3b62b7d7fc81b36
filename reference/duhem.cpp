// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/duhem.h"

#include <algorithm>

namespace fidservo::reference {

namespace {

double high_degC(const DuhemLaw& law) {
    return law.low_degC + law.step_degC * static_cast<double>(law.heating_mm.size() - 1);
}

double on_branch(const DuhemLaw& law, const std::vector<double>& branch_mm, double temp_degC) {
    const double place = (temp_degC - law.low_degC) / law.step_degC;
    const std::size_t left = std::min(static_cast<std::size_t>(place), branch_mm.size() - 2);
    const double share = place - static_cast<double>(left);
    return branch_mm[left] + share * (branch_mm[left + 1] - branch_mm[left]);
}

/// The distance from the contraction to the end of the loop after a move: it shrinks by the same factor as
/// that of the loop's branch, which goes from `from_mm` to `to_mm`.
double remaining_mm(double left_mm, double from_mm, double to_mm) {
    return from_mm > 0.0 ? left_mm * to_mm / from_mm : left_mm;
}

}  // namespace

DuhemLaw make_duhem(const FodTable& table) {
    DuhemLaw law{table.low_degC(), table.step_degC(), {}, {}};
    law.heating_mm.reserve(table.nodes());
    law.cooling_mm.reserve(table.nodes());
    for (std::size_t i = 0; i < table.nodes(); ++i) {
        law.heating_mm.push_back(table.node_mm(i, i));
        law.cooling_mm.push_back(table.node_mm(table.nodes() - 1, i));
    }
    return law;
}

DuhemState heated_to(const DuhemLaw& law, double temp_degC) {
    const double there = std::clamp(temp_degC, law.low_degC, high_degC(law));
    return {there, on_branch(law, law.heating_mm, there)};
}

void move_to(const DuhemLaw& law, DuhemState& state, double temp_degC) {
    const double there = std::clamp(temp_degC, law.low_degC, high_degC(law));
    if (there > state.temp_degC) {
        const double full_mm = law.heating_mm.back();
        const double from_mm = full_mm - on_branch(law, law.heating_mm, state.temp_degC);
        const double to_mm = full_mm - on_branch(law, law.heating_mm, there);
        state.contraction_mm = full_mm - remaining_mm(full_mm - state.contraction_mm, from_mm, to_mm);
    } else if (there < state.temp_degC) {
        const double rest_mm = law.cooling_mm.front();
        const double from_mm = on_branch(law, law.cooling_mm, state.temp_degC) - rest_mm;
        const double to_mm = on_branch(law, law.cooling_mm, there) - rest_mm;
        state.contraction_mm = rest_mm + remaining_mm(state.contraction_mm - rest_mm, from_mm, to_mm);
    }
    state.temp_degC = there;
}

}  // namespace fidservo::reference
