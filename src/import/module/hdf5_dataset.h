// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// One dataset of HDF5 as signals.
#include "src/import/log.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include <hdf5.h>

namespace fidservo::imports {

/// The state of reading a file.
struct Hdf5Reading {
    /// The largest number of skipped objects that are listed by name.
    static constexpr std::size_t most_named = 1'000;

    Log log;
    std::uint64_t values = 0;     ///< numbers read so far
    std::size_t passed_over = 0;  ///< datasets, members and links
    std::string fault{};          ///< why the file as a whole is not read; empty: none

    /// Records an object that cannot be used, with the reason.
    void pass_over(const std::string& name, std::string why) {
        if (++passed_over <= most_named) log.signals.push_back({.name = name, .fault = std::move(why)});
    }
    /// The number of signals that can be used.
    std::size_t usable() const { return log.signals.size() - std::min(passed_over, most_named); }
};

/// Appends the dataset's signals, or its text. What cannot be read of it becomes a signal with a fault.
void read_hdf5_dataset(Hdf5Reading& reading, hid_t dataset, const std::string& name);

}  // namespace fidservo::imports
