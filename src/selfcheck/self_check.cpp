// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/selfcheck/self_check.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "gap/diagnose.h"
#include "src/diagnose/time_limit.h"
#include "src/process/interrupt.h"
#include "src/process/progress.h"
#include "src/selfcheck/draw/campaign.h"
#include "src/selfcheck/draw/case_draw.h"
#include "src/selfcheck/draw/crowded_draw.h"
#include "src/selfcheck/draw/filmed_campaign.h"
#include "src/selfcheck/draw/frames_draw.h"
#include "src/selfcheck/draw/rough_draw.h"
#include "src/selfcheck/ties.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::selfcheck {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void demand_whole_rig(const Rig& rig) {
    const auto demand = [&](bool has, const char* part) {
        if (!has)
            throw InputError(
                fmt::format("--self-check: the rig {} has no {}, which its cases need", rig.name, part));
    };
    demand(rig.micro.has_value(), "micro");
    demand(rig.camera.has_value(), "camera");
    demand(rig.fiducials.has_value(), "fiducials");
    demand(rig.macro.pd.has_value(), "macro.pd");
    demand(rig.micro->pi.has_value(), "micro.pi");
}

void demand_recordings(const Rig& rig, const std::vector<std::string>& names) {
    std::vector<std::string> allowed;
    for (const CampaignRun& run : campaign_runs(rig)) allowed.push_back(run.name);
    for (const std::string& name : names)
        if (std::ranges::find(allowed, name) == allowed.end())
            throw InputError(fmt::format("--recordings: {}: a campaign has no such recording; allowed: {}",
                                         name, fmt::join(allowed, ", ")));
}

gap::Evidence evidence_of(const Rig& nominal, std::vector<Recording> recordings,
                          const SelfCheckOptions& options) {
    const diagnose::TimeLimit limit = diagnose::time_limit(recordings);
    const auto budget = options.limited
                            ? std::make_shared<const gap::Budget>(limit.search_s, limit.whole_s,
                                                                  std::function<bool()>(), *options.limited)
                            : std::make_shared<const gap::Budget>();
    return {nominal, std::move(recordings), budget};
}

/// Sees recordings, the nominal rig, and what the diagnosis is not to try; no label.
gap::Diagnosis diagnose_blindly(const gap::Evidence& evidence, const SelfCheckOptions& options,
                                const std::vector<std::string>& without) {
    const double equation_s = options.limited ? diagnose::time_limit(evidence.recordings()).equation_s : 0.0;
    return gap::diagnose(
        evidence, {.only = options.only, .without = without, .equation_s = equation_s, .selection = {}});
}

Outcome run_case(const Rig& nominal, const Case& drawn, const SelfCheckOptions& options) {
    const Clock::time_point start = Clock::now();
    std::vector<Recording> recordings = has_frames(drawn.label.kind)
                                            ? film_campaign(nominal, drawn.true_rig, drawn.campaign_seed)
                                            : record_campaign(nominal, drawn.true_rig, drawn.campaign_seed);
    if (!options.recordings.empty())
        std::erase_if(recordings, [&](const Recording& recording) {
            return std::ranges::find(options.recordings, recording.name) == options.recordings.end();
        });
    const double recording_s = seconds_since(start);
    const Clock::time_point recorded = Clock::now();
    const gap::Evidence evidence = evidence_of(nominal, recordings, options);
    const gap::Diagnosis diagnosis = diagnose_blindly(evidence, options, drawn.without);
    const double diagnosis_s = seconds_since(recorded);
    Outcome outcome{drawn.number, drawn.label, score(drawn.label, diagnosis, &evidence), recording_s,
                    diagnosis_s};
    if (options.settles_ties)
        outcome.tie = settle_tie(nominal, drawn, recordings, diagnosis, [&](std::vector<Recording> more) {
            return diagnose_blindly(evidence_of(nominal, std::move(more), options), options, drawn.without);
        });
    return outcome;
}

/// Kinds that are drawn together.
struct Family {
    std::string_view kinds;  ///< as --kinds takes them
    bool (*has)(CaseKind kind);
    CaseKind (*kind_of)(std::uint64_t seed, std::size_t number);
    Case (*draw)(const Rig& nominal, std::uint64_t seed, std::size_t number);
};

constexpr std::array families{
    Family{"none, one, two, withheld, unlisted",
           [](CaseKind kind) { return !has_frames(kind) && !is_crowded(kind) && kind != CaseKind::rough; },
           kind_of_case, draw_case},
    Family{"frames, frames-none, frames-withheld", has_frames, kind_of_frames_case, draw_frames_case},
    Family{"three, messy, messy-none", is_crowded, kind_of_crowded_case, draw_crowded_case},
    Family{"rough", [](CaseKind kind) { return kind == CaseKind::rough; }, kind_of_rough_case,
           draw_rough_case}};

/// The first one where no kinds are given. Throws InputError where they are of several.
const Family& family_of(const std::vector<CaseKind>& kinds) {
    std::vector<std::string_view> together;
    for (const Family& family : families) {
        if (std::ranges::all_of(kinds, family.has)) return family;
        together.push_back(family.kinds);
    }
    throw InputError(
        fmt::format("--kinds: of these only such as are drawn together: {}", fmt::join(together, "; or ")));
}

}  // namespace

std::string line_of_last(const SelfCheck& check) {
    const bool has_failed =
        !check.failures.empty() &&
        (check.outcomes.empty() || check.failures.back().number > check.outcomes.back().number);
    if (!has_failed) return line_of(check.outcomes.back());
    const Failure& failure = check.failures.back();
    return fmt::format("case {:4} could not be diagnosed: {}", failure.number, failure.text);
}

SelfCheck run_self_check(const Rig& nominal, const SelfCheckOptions& options,
                         const std::function<void(const SelfCheck&)>& done) {
    demand_whole_rig(nominal);
    const Family& family = family_of(options.kinds);
    demand_recordings(nominal, options.recordings);
    SelfCheck check;
    Progress progress("cases", options.cases);
    for (std::size_t number = options.first; check.finished() < options.cases; ++number) {
        check.was_interrupted = interrupt_requested();
        if (check.was_interrupted) break;
        const CaseKind kind = family.kind_of(options.seed, number);
        if (!options.kinds.empty() && std::ranges::find(options.kinds, kind) == options.kinds.end()) continue;
        try {
            check.outcomes.push_back(run_case(nominal, family.draw(nominal, options.seed, number), options));
        } catch (const std::exception& error) {
            check.failures.push_back({number, error.what()});
        }
        done(check);
        progress.advance();
    }
    progress.finish();
    return check;
}

}  // namespace fidservo::selfcheck
