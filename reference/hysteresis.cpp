// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/hysteresis.h"

namespace fidservo::reference {

HysteresisModel make_hysteresis(const FodTable& table, const HysteresisDepartures& departures) {
    HysteresisModel model{PreisachPlane(table),
                          departures.stress_shift_degC,
                          departures.stress_shift_degC_per_mm,
                          departures.stress_shift_degC_per_mm2,
                          departures.stroke,
                          departures.stroke_fading_per_mm};
    if (departures.law == HysteresisLaw::duhem) model.law = make_duhem(table);
    return model;
}

HysteresisState heated_to(const HysteresisModel& model, double temp_degC) {
    return std::visit(
        [&](const auto& law) -> HysteresisState { return heated_to(law, temp_degC - model.shift_degC); },
        model.law);
}

void move_to(const HysteresisModel& model, HysteresisState& state, double temp_degC) {
    double seen_degC = temp_degC - model.shift_degC;
    if (model.shift_degC_per_mm != 0.0 || model.shift_degC_per_mm2 != 0.0) {
        const double x_mm = contraction_mm(model, state);
        seen_degC -= (model.shift_degC_per_mm + model.shift_degC_per_mm2 * x_mm) * x_mm;
    }
    if (const auto* plane = std::get_if<PreisachPlane>(&model.law))
        move_to(*plane, std::get<Staircase>(state), seen_degC);
    else
        move_to(std::get<DuhemLaw>(model.law), std::get<DuhemState>(state), seen_degC);
}

double contraction_mm(const HysteresisModel& model, const HysteresisState& state) {
    const auto* plane = std::get_if<PreisachPlane>(&model.law);
    const double by_law_mm = plane != nullptr ? contraction_mm(*plane, std::get<Staircase>(state))
                                              : std::get<DuhemState>(state).contraction_mm;
    if (model.stroke_fading_per_mm == 0.0) return model.stroke * by_law_mm;
    return by_law_mm * (1.0 + (model.stroke - 1.0) * (1.0 - model.stroke_fading_per_mm * by_law_mm));
}

}  // namespace fidservo::reference
