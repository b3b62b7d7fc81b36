// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A diagnosis in one sentence of plain words.
#include "gap/diagnosis.h"

#include <string>

namespace fidservo::diagnose {

/// Whether everything was tried, or the reason why not.
std::string end_words(gap::Ended ended);

/// The headline: what causes the gap, or that there is none, or that no known effect explains it.
std::string verdict_sentence(const gap::Diagnosis& diagnosis);

/// The sentences after the headline: how large the gap was, how much of it is explained, and what the data
/// cannot distinguish.
std::string verdict_detail(const gap::Diagnosis& diagnosis);

}  // namespace fidservo::diagnose
