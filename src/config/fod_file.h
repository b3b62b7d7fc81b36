#pragma once
#include "core/preisach.h"

#include <filesystem>

namespace fidservo {

/// Reads a table of first-order descending curves: CSV with the columns peak_temp_degC, temp_degC,
/// contraction_mm, a row for each peak and each lower temperature of one equally spaced grid, in any order.
/// Throws InputError that names file and line.
FodTable load_fod(const std::filesystem::path& file);

}  // namespace fidservo
