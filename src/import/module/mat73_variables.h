// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Variables of MATLAB's format 7.3, which is HDF5. libmatio reads what MATLAB writes, but passes over what
// other programs write: attributes with another padding, structures that do not list their fields.
#include <functional>
#include <memory>
#include <string>

#include <matio.h>

namespace fidservo::imports {

struct FreeVariable {
    void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

/// A variable of the class without data: what is not read, or cannot be.
Variable variable_without_data(matio_classes of);

/// Gives each variable that is no object of MATLAB's, as libmatio holds those of format 5. Arrays with which
/// the file would have more than most_values numbers come without data. What is wrong with the file, or
/// nothing.
std::string read_mat73_variables(
    const char* file, const std::function<void(const std::string& name, const matvar_t& variable)>& take);

}  // namespace fidservo::imports
