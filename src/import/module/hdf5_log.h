// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// HDF5 files by libhdf5.
#include "src/import/log.h"

#include <string>

namespace fidservo::imports {

/// Numeric datasets become signals named by their paths, columns of two-dimensional ones PATH[k], members of
/// compounds PATH.MEMBER, and arrays in them PATH.MEMBER[k]; units and CF attributes are evaluated by
/// hdf5_meaning(). Scalar strings become texts. Whatever is skipped becomes a signal with a fault.
LogOrFault read_hdf5_file(const char* file);

/// Writes each signal as a dataset at the path of its name, with the attribute `unit`.
/// @return an error message; empty on success
std::string write_hdf5_file(const char* file, const Log& log);

}  // namespace fidservo::imports
