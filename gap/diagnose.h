#pragma once
// From recordings to a diagnosis.
#include "gap/diagnosis.h"
#include "gap/selection.h"

#include <string>
#include <vector>

namespace fidservo::gap {

struct DiagnosisOptions {
    std::vector<std::string> only;     ///< effects to try; empty: all
    std::vector<std::string> without;  ///< effects to leave out, with all of their class
    SelectionOptions selection;
};

/// Where the evidence's budget ends before all is done, the best until then. Throws BudgetEnded where that is
/// before anything was predicted.
Diagnosis diagnose(const Evidence& evidence, const DiagnosisOptions& options = {});

}  // namespace fidservo::gap
