// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// HDF5 files by libhdf5.
#include "src/import/log.h"

#include <string>

namespace fidservo::imports {

/// Datasets of numbers by their paths, columns of two dimensions as PATH[k], members of compounds as
/// PATH.MEMBER and arrays in them as PATH.MEMBER[k]; units and CF's attributes by hdf5_meaning(); scalar
/// strings as texts. What is passed over is there under its name, with a fault.
LogOrFault read_hdf5_file(const char* file);

/// A group for each signal's path, with the attribute `unit`. What went wrong, or nothing.
std::string write_hdf5_file(const char* file, const Log& log);

}  // namespace fidservo::imports
