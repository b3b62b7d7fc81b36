// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From recordings to a diagnosis.
#include "gap/diagnosis.h"
#include "gap/search/selection.h"

#include <string>
#include <vector>

namespace fidservo::gap {

/// What a diagnosis is asked to try.
struct DiagnosisOptions {
    std::vector<std::string> only;     ///< effects to try; empty: all
    std::vector<std::string> without;  ///< effects to leave out, with all of their class
    /// Effects that are tried beside those of the catalogue.
    std::vector<const plant::Effect*> formulas = {};
    /// What may be left of a signal that no effect explains without its being called a gap, in the signal's
    /// unit. It never changes what is found, nor how large the discrepancy is said to be.
    SignalLimits matters = {};
    /// How long an equation may be looked for where something is left, s, beyond the evidence's budget; 0:
    /// not at all.
    double equation_s = 0.0;
    SelectionOptions selection;  ///< how the search goes; the defaults are those of the program
};

/// Where the evidence's budget ends before all is done, the best until then. Throws InputError where nothing
/// in the recordings can be judged; throws BudgetEnded where that is before anything was predicted.
Diagnosis diagnose(const Evidence& evidence, const DiagnosisOptions& options = {});

}  // namespace fidservo::gap
