// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The shared practice campaigns, and the scatter of their readings from noise and rounding alone.
#include "src/files/recording/reader.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::testing {

/// The recordings of a campaign of the shared data. Empty where the shared data are absent, unless the
/// environment says FIDSERVO_REQUIRE_DATA: then that is a test failure.
inline std::vector<std::filesystem::path> campaign(std::string_view name) {
    const auto folder = std::filesystem::path(FIDSERVO_DATA_DIR) / "campaigns" / name;
    if (std::filesystem::is_directory(folder)) return find_recordings(folder);
    EXPECT_EQ(std::getenv("FIDSERVO_REQUIRE_DATA"), nullptr) << "the shared data are absent: " << folder;
    return {};
}

inline std::vector<Recording> read_all(const std::vector<std::filesystem::path>& folders) {
    std::vector<Recording> recordings;
    recordings.reserve(folders.size());
    for (const auto& folder : folders) recordings.push_back(read_recording(folder));
    return recordings;
}

/// Mean and variance of (reading - mean reading)^2 in LSB^2.
struct SquareStatistics {
    double mean = 0.0;
    double variance = 0.0;
};

/// The statistics for Gaussian noise followed by rounding. If mean readings are uniform over an LSB the mean
/// is noise^2 + 1/12; for a platform at rest it depends on where it rests.
inline SquareStatistics rounded_gaussian(double mean_lsb, double noise_lsb) {
    constexpr int reach = 5;
    const auto below = [&](double level) {
        return 0.5 * std::erfc((mean_lsb - level) / (noise_lsb * std::numbers::sqrt2));
    };
    SquareStatistics statistics;
    double fourth = 0.0;
    const double nearest = std::floor(mean_lsb + 0.5);
    for (int i = -reach; i <= reach; ++i) {
        const double reading = nearest + i;
        const double probability = below(reading + 0.5) - below(reading - 0.5);
        const double square = (reading - mean_lsb) * (reading - mean_lsb);
        statistics.mean += probability * square;
        fourth += probability * square * square;
    }
    statistics.variance = fourth - statistics.mean * statistics.mean;
    return statistics;
}

}  // namespace fidservo::testing
