// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Variables of MATLAB's format 7.3, which is HDF5. libmatio reads files that MATLAB wrote, but skips
// variables of other programs' files, whose attributes have another padding or whose structures do not list
// their fields.
#include <functional>
#include <memory>
#include <string>

#include <matio.h>

namespace fidservo::imports {

struct FreeVariable {
    void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

/// A variable of a class, without data: the placeholder for one that is not or cannot be read.
Variable variable_without_data(matio_classes of);

/// Calls `take` with each variable that is not one of MATLAB's own objects, in libmatio's representation of
/// format 5. Arrays that would exceed most_values numbers in the file have no data.
/// @return an error message; empty on success
std::string read_mat73_variables(
    const char* file, const std::function<void(const std::string& name, const matvar_t& variable)>& take);

}  // namespace fidservo::imports
