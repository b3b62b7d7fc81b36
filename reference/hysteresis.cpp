#include "reference/hysteresis.h"

namespace fidservo::reference {

HysteresisModel make_hysteresis(const FodTable& table, const HysteresisDepartures& departures) {
    if (departures.law == HysteresisLaw::duhem)
        return {make_duhem(table), departures.stress_shift_degC, departures.stroke};
    return {PreisachPlane(table), departures.stress_shift_degC, departures.stroke};
}

HysteresisState heated_to(const HysteresisModel& model, double temp_degC) {
    return std::visit(
        [&](const auto& law) -> HysteresisState { return heated_to(law, temp_degC - model.shift_degC); },
        model.law);
}

void move_to(const HysteresisModel& model, HysteresisState& state, double temp_degC) {
    const double seen_degC = temp_degC - model.shift_degC;
    if (const auto* plane = std::get_if<PreisachPlane>(&model.law))
        move_to(*plane, std::get<Staircase>(state), seen_degC);
    else
        move_to(std::get<DuhemLaw>(model.law), std::get<DuhemState>(state), seen_degC);
}

double contraction_mm(const HysteresisModel& model, const HysteresisState& state) {
    if (const auto* plane = std::get_if<PreisachPlane>(&model.law))
        return model.stroke * contraction_mm(*plane, std::get<Staircase>(state));
    return model.stroke * std::get<DuhemState>(state).contraction_mm;
}

}  // namespace fidservo::reference
