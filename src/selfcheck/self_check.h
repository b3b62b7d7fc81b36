// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Tests the diagnosis on rigs with known effects: cases are drawn, recorded with the independent model,
// diagnosed without their labels, and scored.
#include "core/result.h"
#include "gap/budget.h"
#include "gap/search/selection.h"
#include "src/selfcheck/tally/outcome.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::selfcheck {

struct SelfCheckOptions {
    std::size_t cases = 300;
    std::size_t first = 0;        ///< number of the first case
    std::vector<CaseKind> kinds;  ///< other kinds are skipped; empty: all those without frames
    std::uint64_t seed = 1;
    std::vector<std::string> only;  ///< effects that the diagnosis tries; empty: all
    /// How the time limits of a diagnosis (src/diagnose/time_limit.h) are measured; if by effort, on one core
    /// only. Empty: no limits.
    std::optional<gap::Seconds> limited = {};
    std::vector<std::string> recordings;  ///< the recordings of a campaign that are made; empty: all
    bool settles_ties = false;  ///< whether ties are settled by a designed experiment (src/selfcheck/ties.h)
};

/// A case that could not be diagnosed.
struct Failure {
    std::size_t number;
    std::string text;
};

struct SelfCheck {
    std::vector<Outcome> outcomes;
    std::vector<Failure> failures;
    bool was_interrupted = false;  ///< ended by the user, after a whole number of cases

    std::size_t finished() const { return outcomes.size() + failures.size(); }
};

/// One line on the case that was finished last: an outcome or a failure.
std::string line_of_last(const SelfCheck& check);

/// Draws, records, diagnoses and scores case after case; Ctrl-C (src/process/interrupt.h) ends it after the
/// present case. Throws InputError if the rig lacks what the cases need (micro stage, camera, fiducials,
/// controllers), and if kinds with and without frames are asked for together.
/// @param done  called after every case with the results so far
SelfCheck run_self_check(const Rig& nominal, const SelfCheckOptions& options,
                         const std::function<void(const SelfCheck&)>& done);

}  // namespace fidservo::selfcheck
