// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/rig/rig_file.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_code.h"
#include "src/files/rig/effects_file.h"
#include "src/files/rig/fod_file.h"
#include "src/files/rig/rig_camera.h"
#include "src/files/rig/stage_keys.h"
#include "src/files/rig/tag_print_keys.h"
#include "src/files/text/yaml_reader.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo {

namespace {

constexpr NumberRange voltage{0.0, 100.0, true};
constexpr NumberRange temperature{-100.0, 500.0};

template <class Read>
auto read_if_given(const YamlValue& map, std::string_view key, Read read)
    -> std::optional<decltype(read(map))> {
    if (const auto value = map.find(key)) return read(*value);
    return std::nullopt;
}

struct Travel {
    double low_mm;
    double high_mm;
};

Travel read_travel(const YamlValue& value) {
    const std::vector<double> ends = value.numbers(2);
    if (ends[0] >= ends[1]) value.fail("must be [low, high] with low below high, in mm");
    return {ends[0], ends[1]};
}

DeadZone read_dead_zone(const YamlValue& map) {
    map.allow_only({"threshold_V", "offset_V", "slope"});
    return {.threshold_V = map.at("threshold_V").number(not_negative),
            .offset_V = map.at("offset_V").number(not_negative),
            .slope = map.at("slope").number(positive)};
}

PdGains read_pd(const YamlValue& map) {
    map.allow_only({"e0_V_per_count", "e1_V_per_count", "friction_V"});
    return {.e0_V_per_count = map.at("e0_V_per_count").number(),
            .e1_V_per_count = map.at("e1_V_per_count").number(),
            .friction_V = map.at("friction_V").number(not_negative)};
}

PidGains read_pid(const YamlValue& map) {
    map.allow_only({"kp_V_per_count", "ki_V_per_count_s", "kd_V_s_per_count"});
    return {.kp_V_per_count = map.at("kp_V_per_count").number(not_negative),
            .ki_V_per_count_s = map.at("ki_V_per_count_s").number(not_negative),
            .kd_V_s_per_count = map.at("kd_V_s_per_count").number(not_negative)};
}

double read_pole(const YamlValue& value) {
    const double pole = value.number();
    if (pole <= 0.0 || pole >= 1.0) value.fail("must be a number above 0 and below 1, per tick");
    return pole;
}

/// The numerator of the identified transfer function repeats gain, pole and tick; it must not contradict
/// them.
void check_numerator(const YamlValue& numerator, const MacroParameters& macro, double tick_s) {
    const double implied = macro.velocity_gain_mm_per_s_per_V * (1.0 - macro.velocity_pole) * tick_s /
                           macro.encoder_resolution_mm;
    if (std::abs(numerator.number(positive) - implied) > 1e-4 * implied)
        numerator.fail(fmt::format(
            "contradicts velocity gain, pole, tick and encoder resolution, which give {:.6g}", implied));
}

MacroParameters read_macro_parameters(const YamlValue& map, double tick_s) {
    map.allow_only({"travel_mm", "command_limit_V", "velocity_gain_mm_per_s_per_V", "velocity_pole",
                    "velocity_numerator_count_per_V", "dead_zone", "encoder_resolution_mm", "pd", "pid"});
    const Travel travel = read_travel(map.at("travel_mm"));
    MacroParameters macro{
        .low_mm = travel.low_mm,
        .high_mm = travel.high_mm,
        .command_limit_V = map.at("command_limit_V").number(voltage),
        .velocity_gain_mm_per_s_per_V = map.at("velocity_gain_mm_per_s_per_V").number(positive),
        .velocity_pole = read_pole(map.at("velocity_pole")),
        .dead_zone = read_if_given(map, "dead_zone", read_dead_zone).value_or(DeadZone{}),
        .encoder_resolution_mm = map.at("encoder_resolution_mm").number(positive),
        .pd = read_if_given(map, "pd", read_pd),
        .pid = read_if_given(map, "pid", read_pid)};
    if (macro.dead_zone.threshold_V >= macro.command_limit_V)
        map.at("dead_zone")
            .at("threshold_V")
            .fail(fmt::format("must be below command_limit_V, {} V", macro.command_limit_V));
    if (const auto numerator = map.find("velocity_numerator_count_per_V"))
        check_numerator(*numerator, macro, tick_s);
    return macro;
}

HeaterParameters read_heater(const YamlValue& map) {
    map.allow_only(
        {"onset_V", "limit_V", "gain_degC_per_V", "heating_tau_s", "cooling_tau_s", "ambient_degC"});
    const HeaterParameters heater{.onset_V = map.at("onset_V").number(not_negative),
                                  .limit_V = map.at("limit_V").number(voltage),
                                  .gain_degC_per_V = map.at("gain_degC_per_V").number(positive),
                                  .heating_tau_s = map.at("heating_tau_s").number(positive),
                                  .cooling_tau_s = map.at("cooling_tau_s").number(positive),
                                  .ambient_degC = map.at("ambient_degC").number(temperature)};
    if (heater.limit_V <= heater.onset_V)
        map.at("limit_V").fail(fmt::format("must be above onset_V, {} V", heater.onset_V));
    return heater;
}

HallParameters read_hall(const YamlValue& map) {
    map.allow_only(
        {"mid_V", "span_V", "centre_mm", "half_range_mm", "cubic", "adc_bits", "adc_range_V", "noise_lsb"});
    return {.mid_V = map.at("mid_V").number(),
            .span_V = map.at("span_V").number(positive),
            .centre_mm = map.at("centre_mm").number(),
            .half_range_mm = map.at("half_range_mm").number(positive),
            .cubic = map.at("cubic").number({0.0, 10.0}),
            .adc_bits = map.at("adc_bits").integer(1, 24),
            .adc_range_V = map.at("adc_range_V").number(voltage),
            .noise_lsb = map.at("noise_lsb").number(not_negative)};
}

PiGains read_pi(const YamlValue& map) {
    map.allow_only({"kp_V_per_mm", "ki_V_per_mm_s", "kaw_per_s", "low_V", "high_V"});
    const PiGains pi{.kp_V_per_mm = map.at("kp_V_per_mm").number(not_negative),
                     .ki_V_per_mm_s = map.at("ki_V_per_mm_s").number(not_negative),
                     .kaw_per_s = map.at("kaw_per_s").number(not_negative),
                     .low_V = map.at("low_V").number(not_negative),
                     .high_V = map.at("high_V").number(voltage)};
    if (pi.high_V <= pi.low_V) map.at("high_V").fail(fmt::format("must be above low_V, {} V", pi.low_V));
    return pi;
}

MicroParameters read_micro(const YamlValue& map) {
    map.allow_only({"travel_mm", "heater", "preisach_fod", "hall", "pi"});
    const Travel travel = read_travel(map.at("travel_mm"));
    const YamlValue fod = map.at("preisach_fod");
    if (!std::filesystem::is_regular_file(fod.file()))
        fod.fail(fmt::format("there is no such file as {}", fod.file().string()));
    return {.low_mm = travel.low_mm,
            .high_mm = travel.high_mm,
            .heater = read_heater(map.at("heater")),
            .fod = std::make_shared<const FodTable>(load_fod(fod.file())),
            .hall = read_hall(map.at("hall")),
            .pi = read_if_given(map, "pi", read_pi)};
}

FiducialParameters read_fiducials(const YamlValue& map) {
    map.allow_only({"family", "border_cells", "inverted", "side_mm", "pitch_mm", "count", "first_id"});
    const TagPrint print = read_tag_print(map);
    const int family_size = print.family->size();
    const std::vector<double> pitch = map.at("pitch_mm").numbers(2, not_negative);
    const std::vector<YamlValue> count = map.at("count").items();
    if (count.size() != 2) map.at("count").fail("must be a list of 2 numbers: columns and rows");
    const FiducialParameters fiducials{.print = print,
                                       .side_mm = map.at("side_mm").number(positive),
                                       .pitch_x_mm = pitch[0],
                                       .pitch_y_mm = pitch[1],
                                       .columns = count[0].integer(1, family_size),
                                       .rows = count[1].integer(1, family_size),
                                       .first_id = read_tag_id(map.at("first_id"), print)};
    if (fiducials.first_id + fiducials.columns * fiducials.rows > family_size)
        map.at("count").fail(fmt::format("the family {} has {} tags", print.family->name, family_size));
    const bool overlap_x = fiducials.columns > 1 && fiducials.pitch_x_mm <= fiducials.side_mm;
    const bool overlap_y = fiducials.rows > 1 && fiducials.pitch_y_mm <= fiducials.side_mm;
    if (overlap_x || overlap_y)
        map.at("pitch_mm").fail(fmt::format("must be above side_mm, {} mm", fiducials.side_mm));
    return fiducials;
}

/// A listed effect's name, then its parameters; those that are left out have typical values.
StatedEffect read_listed_effect(const YamlValue& item) {
    StatedEffect effect;
    effect.name = item.at("name").text();
    for (const std::string& key : item.keys())
        if (key != "name") effect.parameters.push_back({key, item.at(key).number()});
    return effect;
}

/// Fails at the item if its effect, with the values that it states, cannot be.
void demand_setting(const StatedEffect& effect, const YamlValue& item) {
    try {
        const plant::EffectSetting setting = plant::setting_of(effect);
        if (setting.effect->formula != nullptr) setting.effect->formula->demand_extents(setting.values);
    } catch (const plant::FormulaFault& fault) {
        fail_at_formula(item, fault);
    } catch (const InputError& error) {
        item.fail(error.what());
    }
}

std::vector<StatedEffect> read_effects(const YamlValue& list) {
    std::vector<StatedEffect> effects;
    for (const YamlValue& item : list.items()) {
        StatedEffect& effect =
            effects.emplace_back(item.find("formula") ? read_stated_formula(item) : read_listed_effect(item));
        if (std::ranges::count(effects, effect.name, &StatedEffect::name) > 1)
            item.at("name").fail("is stated twice; an effect can be stated once only");
        effect.stated_at = item.place();
        demand_setting(effect, item);
    }
    return effects;
}

}  // namespace

Rig load_rig(const std::filesystem::path& file) {
    const YamlValue root = YamlValue::load(file);
    root.allow_only(
        {"name", "tick_s", "macro", "micro", "camera", "fiducials", "stage", "effects", "identified"});
    if (const auto stage = root.find("stage")) (void)read_stage_keys(*stage);
    const double tick_s = root.at("tick_s").number({0.0, 1.0, true});
    return {.name = root.at("name").text(),
            .tick_s = tick_s,
            .macro = read_macro_parameters(root.at("macro"), tick_s),
            .micro = read_if_given(root, "micro", read_micro),
            .camera = read_if_given(root, "camera", read_rig_camera),
            .fiducials = read_if_given(root, "fiducials", read_fiducials),
            .effects = read_if_given(root, "effects", read_effects).value_or(std::vector<StatedEffect>{})};
}

std::vector<std::filesystem::path> files_of_rig(const std::filesystem::path& file) {
    const YamlValue root = YamlValue::load(file);
    std::vector<std::filesystem::path> files{file};
    for (const auto& [part, key] : {std::pair{"micro", "preisach_fod"}, std::pair{"camera", "camera_info"}})
        if (const auto map = root.find(part))
            if (const auto named = map->find(key)) files.push_back(named->file());
    return files;
}

std::filesystem::path reference_rig_file() {
    constexpr const char* name = "rig.yaml";
    std::error_code error;
    const std::filesystem::path program =
        std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
    if (!error)
        for (const char* folder : {"../share/fidservo", "../../assets"})
            if (auto file = (program / folder / name).lexically_normal();
                std::filesystem::exists(file, error))
                return file;
    return std::filesystem::path(FIDSERVO_SOURCE_ASSETS) / name;
}

}  // namespace fidservo
