// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Judgements of a fleet in plain words.
#include "src/fleet/report/findings.h"

#include <string>
#include <string_view>
#include <vector>

namespace fidservo::fleet {

/// "the model is wrong for all units", "batch 7", "unit P-0007".
std::string whose_words(const FleetFindings& findings, const Judgement& judgement);

/// The text for a report without a judgement: that no unit stands out; for fewer than three units, where
/// deviations cannot be attributed, what their diagnoses name; or that nothing was diagnosed.
std::string nothing_stands_out(const FleetFindings& findings);

/// The finding in one sentence.
std::string matter_sentence(const FleetFindings& findings, const Judgement& judgement);

/// The evidence for it, in sentences.
std::string evidence_sentences(const FleetFindings& findings, const Judgement& judgement);

/// What to do, in sentences for a technician.
std::vector<std::string> what_to_do(const FleetFindings& findings, const Judgement& judgement);

/// A value with its unit: "1.02", "38.5 um".
std::string value_words(const Quantity& quantity, double floors);

/// The difference from the rig file's value: "+8.5 um".
std::string change_words(const Quantity& quantity, double floors);

/// Names of units: the first few, and the number of the others.
std::string unit_names(const FleetFindings& findings, const std::vector<std::size_t>& units,
                       std::size_t most = 8);

/// For files: "all", "group", "unit".
std::string_view name_of(Whose whose);
/// For files: "deviation", "step", "trend".
std::string_view name_of(Matter matter);

}  // namespace fidservo::fleet
