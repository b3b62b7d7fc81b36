// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/preisach.h"

#include <filesystem>
#include <string>

namespace fidservo {

/// Reads a table of first-order descending curves: CSV with the columns peak_temp_degC, temp_degC,
/// contraction_mm, a row for each peak and each lower temperature of one equally spaced grid, in any order.
/// Throws InputError that names file and line.
FodTable load_fod(const std::filesystem::path& file);

/// The same table as text, contraction to 0.01 um.
std::string fod_text(const FodTable& table);

}  // namespace fidservo
