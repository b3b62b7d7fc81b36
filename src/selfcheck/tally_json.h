// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "src/selfcheck/self_check.h"
#include "src/selfcheck/tally/tally.h"

#include <string>

namespace fidservo::selfcheck {

/// The file of `diagnose --self-check --json`: format fidservo-self-check/1. Figures with their intervals,
/// and every case with its truth and its score.
std::string self_check_json(const SelfCheckOptions& options, const SelfCheck& check, const Tally& tally);

}  // namespace fidservo::selfcheck
