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

Diagnosis diagnose(const Evidence& evidence, const DiagnosisOptions& options = {});

}  // namespace fidservo::gap
