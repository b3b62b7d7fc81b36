#include "plant/micro_stage.h"

#include "core/demand.h"
#include "core/rig.h"

#include <algorithm>

namespace fidservo::plant {

namespace {

double hall_disturbance_V(const MicroStage& stage, const MicroStageState& state) {
    const HallDisturbance& disturbance = stage.hall_disturbance;
    if (disturbance.is_none()) return 0.0;
    return disturbance.drift_V(seconds(state.time_ns)) + disturbance.leak_V_per_V * state.drive_V;
}

}  // namespace

std::optional<MicroStageParameters> micro_stage_parameters(const Rig& rig) {
    if (!rig.micro) return std::nullopt;
    return MicroStageParameters{.heater = rig.micro->heater, .fod = rig.micro->fod, .hall = rig.micro->hall};
}

MicroStage make_micro_stage(const MicroStageParameters& parameters, double tick_s) {
    FIDSERVO_DEMAND(parameters.fod != nullptr);
    MicroStage stage{make_heater(parameters.heater, tick_s, parameters.mass, parameters.heater_delay_s),
                     parameters.fod,
                     parameters.table_shift_degC,
                     parameters.table_shift_degC_per_mm,
                     parameters.stroke_factor,
                     std::nullopt,
                     make_hall_sensor(parameters.hall),
                     parameters.hall_disturbance,
                     parameters.hall_disturbance.leak_share(tick_s),
                     nanoseconds(tick_s)};
    if (parameters.swing.gain != 0.0) stage.swing = make_platform_swing(parameters.swing, tick_s);
    return stage;
}

MicroStageState start(const MicroStage& stage, std::uint64_t seed) {
    const double extended_degC = stage.heater.parameters.ambient_degC - stage.table_shift_degC;
    MicroStageState state{
        start(stage.heater), preisach_start(*stage.fod, extended_degC), 0.0, {seed, "hall"}};
    state.position_mm = stage.stroke_factor * state.wire.contraction_mm;
    return state;
}

double table_degC(const MicroStage& stage, const MicroStageState& state) {
    const double contraction_mm = stage.stroke_factor * state.wire.contraction_mm;
    return state.heater.temp_degC - stage.table_shift_degC - stage.table_shift_degC_per_mm * contraction_mm;
}

double mean_reading_lsb(const MicroStage& stage, const MicroStageState& state) {
    return mean_reading_lsb(stage.hall, state.position_mm) +
           hall_disturbance_V(stage, state) * stage.hall.lsb_per_V;
}

int sample(const MicroStage& stage, MicroStageState& state) {
    return sample(stage.hall, state.hall_noise, state.position_mm, hall_disturbance_V(stage, state));
}

void advance(const MicroStage& stage, MicroStageState& state, double command_V,
             const CarriageInfluence& carriage) {
    advance(stage.heater, state.heater, command_V);
    state.position_mm = stage.stroke_factor * preisach_step(*stage.fod, state.wire, table_degC(stage, state));
    if (stage.swing) {
        advance(*stage.swing, state.swing, carriage.shaking);
        state.position_mm += state.swing.position_mm;
    }
    state.time_ns += stage.tick_ns;
    state.drive_V += stage.leak_share * (carriage.drive_V - state.drive_V);
}

}  // namespace fidservo::plant
