// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// From recordings to a diagnosis.
#include "gap/diagnosis.h"
#include "gap/search/selection.h"

#include <string>
#include <vector>

namespace fidservo::gap {

/// What a diagnosis is to try.
struct DiagnosisOptions {
    std::vector<std::string> only;     ///< effects to try; empty: all
    std::vector<std::string> without;  ///< effects to leave out, with all of their class
    /// Effects besides those of the catalogue.
    std::vector<const plant::Effect*> formulas = {};
    /// For each signal, in its unit, the unexplained discrepancy up to which no gap is reported. It does not
    /// change which effects are found, nor the size of the discrepancy.
    SignalLimits matters = {};
    /// Additional time for finding an equation where something remains unexplained, s; 0: none is searched
    /// for.
    double equation_s = 0.0;
    SelectionOptions selection;  ///< options of the search; the defaults are those of the program
};

/// Where the evidence's budget ends before everything is done, the best result until then is returned. Throws
/// InputError where nothing in the recordings can be judged; throws BudgetEnded where the budget ends before
/// anything was predicted.
Diagnosis diagnose(const Evidence& evidence, const DiagnosisOptions& options = {});

}  // namespace fidservo::gap
