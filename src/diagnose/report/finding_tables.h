// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The effects found and the effects tried, as tables.
#include "gap/diagnosis.h"

#include <string>

namespace fidservo::diagnose {

/// The effects of the explanation: what each is, its parameters, what else it may be, how to check and cure.
std::string found_effects_html(const gap::Diagnosis& diagnosis);

/// Every effect that was tried, with bars of probability and of the gap that it removes alone.
std::string candidates_html(const gap::Diagnosis& diagnosis);

}  // namespace fidservo::diagnose
