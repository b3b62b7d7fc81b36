// SPDX-License-Identifier: GPL-3.0-or-later
#include "plant/effects/catalogue.h"

#include "core/demand.h"
#include "core/input_error.h"
#include "core/rig.h"
#include "plant/formulas/formula_effect.h"

#include <algorithm>
#include <array>
#include <string>

namespace fidservo::plant {

namespace effects {

extern const Effect drive_gain, drive_delay, drive_offset, coulomb_friction, stribeck_friction,
    viscous_friction, friction_asymmetry, presliding, rail_patch, cogging, cable_force, payload,
    belt_compliance, backlash, encoder_scale, encoder_ripple, ambient_temperature, airflow, heater_gain,
    heating_lag, second_thermal_mass, heater_delay, stress_shift, stroke_change, macro_coupling, hall_gain,
    hall_offset, hall_nonlinearity, hall_drift, hall_crosstalk, pixel_scale, camera_rotation, camera_tilt,
    lens_distortion, camera_latency, clock_skew, defocus, motion_blur, uneven_light, sensor_noise,
    rolling_shutter;

}  // namespace effects

namespace {

constinit const std::array catalogue{
    &effects::drive_gain,
    &effects::drive_delay,
    &effects::drive_offset,
    &effects::coulomb_friction,
    &effects::stribeck_friction,
    &effects::viscous_friction,
    &effects::friction_asymmetry,
    &effects::presliding,
    &effects::rail_patch,
    &effects::cogging,
    &effects::cable_force,
    &effects::payload,
    &effects::belt_compliance,
    &effects::backlash,
    &effects::encoder_scale,
    &effects::encoder_ripple,
    &effects::ambient_temperature,
    &effects::airflow,
    &effects::heater_gain,
    &effects::heating_lag,
    &effects::second_thermal_mass,
    &effects::heater_delay,
    &effects::stress_shift,
    &effects::stroke_change,
    &effects::macro_coupling,
    &effects::hall_gain,
    &effects::hall_offset,
    &effects::hall_nonlinearity,
    &effects::hall_drift,
    &effects::hall_crosstalk,
    &effects::pixel_scale,
    &effects::camera_rotation,
    &effects::camera_tilt,
    &effects::lens_distortion,
    &effects::camera_latency,
    &effects::clock_skew,
    &effects::defocus,
    &effects::motion_blur,
    &effects::uneven_light,
    &effects::sensor_noise,
    &effects::rolling_shutter,
};

/// Whether the rig has what a part belongs to.
bool has_part(const PlantParameters& plant, Part part) {
    if (is_of_platform(part)) return plant.micro.has_value();
    return !is_of_camera(part) || plant.camera.has_value();
}

}  // namespace

std::span<const Effect* const> effect_catalogue() {
    return catalogue;
}

const Effect* find_effect(std::string_view name) {
    const auto found = std::ranges::find(catalogue, name, [](const Effect* effect) { return effect->name; });
    return found == catalogue.end() ? nullptr : *found;
}

const Effect* find_effect(std::string_view name, std::span<const Effect* const> others) {
    const auto found = std::ranges::find(others, name, [](const Effect* effect) { return effect->name; });
    return found == others.end() ? find_effect(name) : *found;
}

void put(const Effect& effect, PlantParameters& plant, std::span<const double> values,
         const std::string& stated_at) {
    if (effect.formula != nullptr)
        add_formula(*effect.formula, plant, values, stated_at);
    else
        effect.apply(plant, values);
}

StatedEffect stated(const EffectSetting& setting) {
    const Effect& effect = *setting.effect;
    StatedEffect in_file{std::string(effect.name), {}};
    if (effect.formula != nullptr) in_file.formula = effect.formula->effect();
    for (std::size_t k = 0; k < setting.values.size(); ++k)
        in_file.parameters.push_back({std::string(effect.parameters[k].name), setting.values[k]});
    return in_file;
}

EffectSetting typical_setting(const Effect& effect) {
    EffectSetting setting{&effect, {}};
    for (const EffectParameter& parameter : effect.parameters) setting.values.push_back(parameter.typical);
    return setting;
}

EffectSetting vanishing_setting(const Effect& effect) {
    EffectSetting setting{&effect, {}};
    for (const EffectParameter& parameter : effect.parameters) setting.values.push_back(parameter.vanishing);
    return setting;
}

void apply_effects(PlantParameters& plant, std::span<const EffectSetting> effects,
                   const std::string& stated_at) {
    const std::string where = (stated_at.empty() ? "--effect" : stated_at) + ": ";
    for (std::size_t k = 0; k < effects.size(); ++k) {
        const Effect& effect = *effects[k].effect;
        FIDSERVO_DEMAND(effects[k].values.size() == effect.parameters.size());
        const auto earlier = effects.first(k);
        if (std::ranges::any_of(earlier, [&](const EffectSetting& other) { return other.effect == &effect; }))
            throw InputError(where + std::string(effect.name) + ": an effect can be given once only");
        if (!has_part(plant, effect.part))
            throw InputError(where + std::string(effect.name) + ": the rig has no " +
                             std::string(effect.block.substr(0, effect.block.find('.'))) +
                             " part for it to act on");
        put(effect, plant, effects[k].values, stated_at);
    }
}

StagePlant make_stage_plant(const Rig& rig, std::span<const EffectSetting> effects) {
    PlantParameters parameters = plant_parameters(rig);
    apply_effects(parameters, effects);
    return make_stage_plant(parameters);
}

}  // namespace fidservo::plant
