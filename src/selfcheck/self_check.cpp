#include "src/selfcheck/self_check.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "gap/diagnose.h"
#include "src/interrupt.h"
#include "src/progress.h"
#include "src/selfcheck/campaign.h"
#include "src/selfcheck/case_draw.h"
#include "src/selfcheck/filmed_campaign.h"
#include "src/selfcheck/frames_draw.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include <fmt/format.h>

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

/// Sees recordings, the nominal rig, and what the diagnosis is not to try; no label.
gap::Diagnosis diagnose_blindly(const Rig& nominal, std::vector<Recording> recordings,
                                const std::vector<std::string>& only,
                                const std::vector<std::string>& without) {
    const gap::Evidence evidence(nominal, std::move(recordings));
    return gap::diagnose(evidence, {.only = only, .without = without, .selection = {}});
}

Outcome run_case(const Rig& nominal, const Case& drawn, const std::vector<std::string>& only) {
    const Clock::time_point start = Clock::now();
    const auto record = has_frames(drawn.label.kind) ? film_campaign : record_campaign;
    std::vector<Recording> recordings = record(nominal, drawn.true_rig, drawn.campaign_seed);
    const double recording_s = seconds_since(start);
    const Clock::time_point recorded = Clock::now();
    const gap::Diagnosis diagnosis = diagnose_blindly(nominal, std::move(recordings), only, drawn.without);
    const double diagnosis_s = seconds_since(recorded);
    return {drawn.number, drawn.label, score(drawn.label, diagnosis), recording_s, diagnosis_s};
}

/// Throws InputError where some of the kinds have frames and others have none.
bool are_with_frames(const std::vector<CaseKind>& kinds) {
    const auto with_frames = static_cast<std::size_t>(std::ranges::count_if(kinds, has_frames));
    if (with_frames != 0 && with_frames != kinds.size())
        throw InputError(
            "--kinds: frames, frames-none and frames-withheld do not go with kinds that have no frames");
    return with_frames != 0;
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
    const bool with_frames = are_with_frames(options.kinds);
    const auto kind_of = with_frames ? kind_of_frames_case : kind_of_case;
    const auto draw = with_frames ? draw_frames_case : draw_case;
    SelfCheck check;
    Progress progress("cases", options.cases);
    for (std::size_t number = options.first; check.finished() < options.cases; ++number) {
        check.was_interrupted = interrupt_requested();
        if (check.was_interrupted) break;
        const CaseKind kind = kind_of(options.seed, number);
        if (!options.kinds.empty() && std::ranges::find(options.kinds, kind) == options.kinds.end()) continue;
        try {
            check.outcomes.push_back(run_case(nominal, draw(nominal, options.seed, number), options.only));
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
