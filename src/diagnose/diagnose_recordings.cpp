// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/diagnose_recordings.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "plant/formulas/formula_code.h"
#include "plant/formulas/formula_effect.h"
#include "src/diagnose/matters.h"
#include "src/diagnose/next_experiment.h"
#include "src/diagnose/thinned.h"
#include "src/files/rig/effects_file.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

TimeLimit limit_of(const Conduct& conduct, const std::vector<Recording>& recordings) {
    if (conduct.is_brief) return {half_a_minute.search_s, half_a_minute.whole_s};
    TimeLimit limit = time_limit(recordings);
    if (!conduct.effort_s) return limit;
    if (!(*conduct.effort_s > 0.0))
        throw InputError(fmt::format("effort: {} s: must be positive", *conduct.effort_s));
    const double times = *conduct.effort_s / usual_effort_s();
    return {times * limit.search_s, times * limit.whole_s, times * limit.equation_s};
}

/// The formulas of an effects file but those that the rig file states, which are tried in any case. Throws
/// InputError where another one has the name of a stated one.
std::vector<const plant::Effect*> formulas_beside(const Rig& rig, const std::filesystem::path& file) {
    std::vector<const plant::Effect*> formulas = load_effects_file(file);
    std::erase_if(formulas, [&](const plant::Effect* formula) {
        const auto stated = std::ranges::find(rig.effects, formula->name, &StatedEffect::name);
        if (stated == rig.effects.end() || !stated->formula) return false;
        if (*stated->formula == formula->formula->effect()) return true;
        throw InputError(
            fmt::format("--effects-file: {}: {}: the rig file states another formula of that name; "
                        "allowed: another name",
                        file.string(), formula->name));
    });
    return formulas;
}

double gone_since(std::chrono::steady_clock::time_point then) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

}  // namespace

double usual_effort_s() {
    return half_a_minute.whole_s + half_a_minute.equation_s;
}

gap::DiagnosisOptions options_of(const Asked& asked, const Rig& rig) {
    gap::DiagnosisOptions options{.only = asked.only, .without = asked.without, .selection = {}};
    if (!asked.effects_file.empty()) options.formulas = formulas_beside(rig, asked.effects_file);
    std::vector<const plant::Effect*> known = options.formulas;
    for (const StatedEffect& stated : rig.effects)
        if (stated.formula) known.push_back(&plant::refit_of(stated));
    demand_effects("--effects", asked.only, known);
    demand_effects("--without", asked.without, known);
    options.matters = what_matters(asked.matters, rig);
    return options;
}

Answer diagnose_recordings(const Rig& rig, ReadRecordings read, gap::DiagnosisOptions options,
                           const Conduct& conduct) {
    const bool by_effort = conduct.effort_s.has_value();
    const TimeLimit limit = limit_of(conduct, read.recordings);
    const double gone_s = by_effort ? 0.0 : gone_since(conduct.since);
    const auto budget = std::make_shared<const gap::Budget>(
        limit.search_s - gone_s, limit.whole_s - gone_s, conduct.interrupted,
        by_effort ? gap::Seconds::by_effort : gap::Seconds::by_clock);
    if (conduct.tell)
        options.selection.search.tell = [&, budget](std::string_view what) {
            const double spent_s = by_effort ? static_cast<double>(budget->rows()) / gap::rows_a_second
                                             : gone_since(conduct.since);
            conduct.tell(what, std::min(1.0, spent_s / limit.whole_s));
        };
    options.equation_s = limit.equation_s;
    gap::Evidence evidence(rig, thinned(std::move(read.recordings), read.notes), budget);
    gap::Diagnosis diagnosis = gap::diagnose(evidence, options);
    diagnosis.notes.insert(diagnosis.notes.end(), read.notes.begin(), read.notes.end());
    if (!conduct.is_brief)
        diagnosis.next_experiment = next_experiment(evidence.rig(), diagnosis, conduct.interrupted);
    return {std::move(evidence), std::move(diagnosis), limit};
}

}  // namespace fidservo::diagnose
