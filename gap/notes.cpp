// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/notes.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "gap/evidence/noise_floor.h"
#include "gap/fit/gap_size.h"
#include "plant/effects/catalogue.h"
#include "plant/effects/together.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace fidservo::gap {
namespace {

/// Signals whose discrepancy is no gap by what the user says.
void add_what_does_not_matter(const SignalLimits& matters, Diagnosis& diagnosis) {
    for (const SignalGap& signal : diagnosis.signals) {
        const double limit = matters[index_of(signal.signal)];
        if (limit <= 0.0 || !is_left(signal) || signal.discrepancy > limit) continue;
        diagnosis.notes.push_back(fmt::format(
            "{}: {:.3g} {} r.m.s. remain that no effect explains, not more than the {:.3g} {} that "
            "matter",
            name_of(signal.signal), signal.discrepancy, unit_of(signal.signal), limit,
            unit_of(signal.signal)));
    }
}

/// A formula that the rig file states: its values take the place of the stated ones.
std::string replacement_note(const StatedEffect& stated, const plant::EffectSetting& found) {
    std::string note =
        fmt::format("{}: the rig file states it; these values take the place of", found.effect->name);
    const char* separator = " ";
    const std::vector<double> before = plant::setting_of(stated).values;
    for (std::size_t k = 0; k < before.size(); ++k) {
        note += fmt::format("{}{} = {:.6g}", separator, found.effect->parameters[k].name, before[k]);
        separator = ", ";
    }
    return note;
}

/// What effects come to that the rig file states already: their values are what was found beside it, or
/// instead of it.
void add_what_is_stated_already(const Rig& rig, Diagnosis& diagnosis) {
    for (const plant::EffectSetting& found : diagnosis.hypothesis) {
        const auto stated = std::ranges::find(rig.effects, found.effect->name, &StatedEffect::name);
        if (stated == rig.effects.end()) continue;
        if (stated->formula) {
            diagnosis.notes.push_back(replacement_note(*stated, found));
            continue;
        }
        std::string note = fmt::format("{}: the rig file states it already, these values come beside it",
                                       found.effect->name);
        try {
            for (const StatedEffect::Parameter& parameter :
                 plant::together(*stated, plant::stated(found)).parameters)
                note += fmt::format("{} {} = {:.6g}", note.find(';') == std::string::npos ? "; in all" : ",",
                                    parameter.name, parameter.value);
        } catch (const InputError& error) {
            note += fmt::format("; {}", error.what());
        }
        diagnosis.notes.push_back(std::move(note));
    }
}

/// A reading that scatters at rest more than its rig file says: whatever scatters there counts as noise.
void add_noise_beyond_file(const Evidence& evidence, Diagnosis& diagnosis) {
    if (!evidence.rig().micro) return;
    const double floor_adc = evidence.floor(Signal::hall),
                 by_file_adc = floor_of(evidence.rig().micro->hall.noise_lsb);
    if (!(floor_adc > least_floors * by_file_adc)) return;
    diagnosis.notes.push_back(fmt::format(
        "hall: at rest its readings scatter by {:.3g} adc r.m.s., by the rig file by {:.3g}: gaps "
        "below that are not seen",
        floor_adc, by_file_adc));
}

}  // namespace

void add_notes(const Evidence& evidence, const SignalLimits& matters, Diagnosis& diagnosis) {
    add_what_does_not_matter(matters, diagnosis);
    add_what_is_stated_already(evidence.rig(), diagnosis);
    add_noise_beyond_file(evidence, diagnosis);
}

}  // namespace fidservo::gap
