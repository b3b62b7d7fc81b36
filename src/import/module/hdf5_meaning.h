// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The meaning of the numbers in an HDF5 dataset, by its attributes.
#include <cstddef>
#include <string>
#include <vector>

#include <hdf5.h>

namespace fidservo::imports {

/// The unit, and how stored numbers become values by the conventions of CF (cfconventions.org, 2.5.1 and
/// 8.1): value = scale x number + offset, except where the number is that of a missing sample.
struct Hdf5Meaning {
    std::string unit{};  ///< empty: no unit is stated, or two different ones
    double scale = 1.0, offset = 0.0;
    std::vector<double> missing{};    ///< numbers that stand for missing samples
    std::string fault{};              ///< why the numbers cannot be interpreted; empty: no fault
    std::vector<std::string> said{};  ///< notes for the user, as parts of a sentence

    bool is_identity() const { return scale == 1.0 && offset == 0.0 && missing.empty(); }
    /// NaN where the sample is missing.
    double value(double number) const;
};

/// The meaning by the attributes `unit` or `units`, `scale_factor`, `add_offset`, `_FillValue` and
/// `missing_value`, and by a unit at the end of the dataset's name.
Hdf5Meaning hdf5_meaning(hid_t dataset, const std::string& name);

}  // namespace fidservo::imports
