#include "plant/micro_stage.h"

#include "core/failure.h"

namespace fidservo::plant {

std::optional<MicroStageParameters> micro_stage_parameters(const Rig& rig) {
    if (!rig.micro) return std::nullopt;
    return MicroStageParameters{.heater = rig.micro->heater, .fod = rig.micro->fod, .hall = rig.micro->hall};
}

MicroStage make_micro_stage(const MicroStageParameters& parameters, double tick_s) {
    FIDSERVO_DEMAND(parameters.fod != nullptr);
    return {make_heater(parameters.heater, tick_s), parameters.fod, parameters.stroke_factor,
            make_hall_sensor(parameters.hall)};
}

MicroStageState start(const MicroStage& stage, std::uint64_t seed) {
    const double ambient_degC = stage.heater.parameters.ambient_degC;
    MicroStageState state{{ambient_degC}, preisach_start(*stage.fod, ambient_degC), 0.0, {seed, "hall"}};
    state.position_mm = stage.stroke_factor * state.wire.contraction_mm;
    return state;
}

void advance(const MicroStage& stage, MicroStageState& state, double command_V) {
    advance(stage.heater, state.heater, command_V);
    state.position_mm = stage.stroke_factor * preisach_step(*stage.fod, state.wire, state.heater.temp_degC);
}

}  // namespace fidservo::plant
