// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A diagnosis in one sentence of plain words.
#include "gap/diagnosis.h"

#include <string>

namespace fidservo::diagnose {

/// Whether all was tried, or why not.
std::string end_words(gap::Ended ended);

/// The headline: what causes the gap, or that there is none, or that no known effect explains it.
std::string verdict_sentence(const gap::Diagnosis& diagnosis);

/// What follows it: how large the gap was, how much of it goes, what the data cannot tell apart.
std::string verdict_detail(const gap::Diagnosis& diagnosis);

}  // namespace fidservo::diagnose
