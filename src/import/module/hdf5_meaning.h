// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the attributes of a dataset of HDF5 say of its numbers.
#include <cstddef>
#include <string>
#include <vector>

#include <hdf5.h>

namespace fidservo::imports {

/// The unit, and how stored numbers become values by the conventions of CF (cfconventions.org, 2.5.1 and
/// 8.1): value = scale x number + offset, except where the number is that of a missing sample.
struct Hdf5Meaning {
    std::string unit{};  ///< empty: none is stated, or two that differ
    double scale = 1.0, offset = 0.0;
    std::vector<double> missing{};    ///< numbers that stand for missing samples
    std::string fault{};              ///< why the attributes cannot be followed
    std::vector<std::string> said{};  ///< what the user has to know of it, in parts of a sentence

    bool is_identity() const { return scale == 1.0 && offset == 0.0 && missing.empty(); }
    /// NaN where the sample is missing.
    double value(double number) const;
};

/// By the attributes `unit` or `units`, `scale_factor`, `add_offset`, `_FillValue` and `missing_value`, and
/// the unit that the dataset's name ends in.
Hdf5Meaning hdf5_meaning(hid_t dataset, const std::string& name);

}  // namespace fidservo::imports
