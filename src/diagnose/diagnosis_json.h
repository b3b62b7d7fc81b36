// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "gap/diagnosis.h"

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace fidservo {

/// The evidence for a named effect: the numbers described in docs/diagnosis.md.
nlohmann::ordered_json support_json(const gap::Support& support);

/// The file of `diagnose --json`: format fidservo-diagnosis/1.
std::string diagnosis_json(const gap::Diagnosis& diagnosis);

/// The result of a diagnosis as text for a terminal.
std::string describe(const gap::Diagnosis& diagnosis);

/// A copy of a rig file with the diagnosed effects, beside or in one with those that it states
/// (RigEdit::add_effect). Throws InputError if `file` exists, or where the two cannot be one.
void write_diagnosed_rig(const std::filesystem::path& file, const std::filesystem::path& source,
                         const gap::Diagnosis& diagnosis);

}  // namespace fidservo
