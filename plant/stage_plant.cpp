// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/stage_plant.h"

#include "core/demand.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"

namespace fidservo::plant {

PlantParameters plant_parameters(const Rig& rig) {
    PlantParameters parameters{.tick_s = rig.tick_s,
                               .axis = macro_axis_parameters(rig),
                               .encoder = {rig.macro.encoder_resolution_mm},
                               .micro = micro_stage_parameters(rig),
                               .camera = std::nullopt};
    if (rig.camera) parameters.camera.emplace();
    for (const StatedEffect& stated : rig.effects) {
        const EffectSetting setting = setting_of(stated);
        apply_effects(parameters, {&setting, 1}, stated.stated_at);
    }
    return parameters;
}

StagePlant make_stage_plant(const PlantParameters& parameters) {
    StagePlant plant{parameters.tick_s, make_macro_axis(parameters.axis, parameters.tick_s),
                     parameters.encoder, std::nullopt, parameters.camera};
    if (parameters.micro) plant.micro = make_micro_stage(*parameters.micro, parameters.tick_s);
    return plant;
}

StagePlant make_stage_plant(const Rig& rig) {
    return make_stage_plant(plant_parameters(rig));
}

StageState start(const StagePlant& plant, double carriage_mm, std::uint64_t seed, EncoderOrigin origin) {
    FIDSERVO_DEMAND(carriage_mm >= plant.axis.parameters.low_mm &&
                    carriage_mm <= plant.axis.parameters.high_mm);
    StageState state{start(plant.axis, carriage_mm), start(plant.encoder, carriage_mm, origin), std::nullopt};
    if (plant.micro) state.micro.emplace(start(*plant.micro, seed));
    return state;
}

StageReading sample(const StagePlant& plant, StageState& state) {
    StageReading reading{sample(plant.encoder, state.encoder, state.axis.position_mm), 0};
    if (state.micro) reading.hall_adc = sample(*plant.micro, *state.micro);
    return reading;
}

void advance(const StagePlant& plant, StageState& state, double macro_V, double micro_V) {
    const double before_mm = state.axis.position_mm, before_mm_per_s = state.axis.velocity_mm_per_s;
    advance(plant.axis, state.axis, macro_V);
    if (!state.micro) return;
    CarriageInfluence carriage;
    if (plant.micro->feels_carriage())
        carriage = {shaking_of(state.axis.position_mm - before_mm, before_mm_per_s,
                               state.axis.velocity_mm_per_s, plant.tick_s),
                    drive_voltage_V(plant.axis.parameters, macro_V), state.axis.position_mm,
                    state.axis.velocity_mm_per_s};
    advance(*plant.micro, *state.micro, micro_V, carriage);
}

double camera_position_mm(const StageState& state) {
    return state.axis.position_mm + (state.micro ? state.micro->position_mm : 0.0);
}

}  // namespace fidservo::plant
