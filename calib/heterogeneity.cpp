// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/heterogeneity.h"

#include "calib/tails.h"
#include "core/demand.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::calib {

namespace {

/// The mean of recordings that have values of their own.
void find_mean(std::span<const RecordingEstimate> recordings, Heterogeneity& found) {
    double weights = 0.0, scatter = 0.0;
    const auto weight = [&](const RecordingEstimate& of) {
        return 1.0 / (of.std * of.std + found.between_std * found.between_std);
    };
    for (const RecordingEstimate& recording : recordings) {
        weights += weight(recording);
        found.mean += weight(recording) * recording.value;
    }
    found.mean /= weights;
    for (const RecordingEstimate& recording : recordings)
        scatter += weight(recording) * std::pow(recording.value - found.mean, 2);
    found.mean_variance = std::max(1.0, scatter / found.added_freedom) / weights;
}

/// The two recordings with the largest difference in its standard errors.
void find_farthest(std::span<const RecordingEstimate> recordings, Heterogeneity& found) {
    for (std::size_t i = 0; i < recordings.size(); ++i)
        for (std::size_t j = i + 1; j < recordings.size(); ++j) {
            const RecordingEstimate &a = recordings[i], &b = recordings[j];
            const double apart = std::abs(a.value - b.value) / std::hypot(a.std, b.std);
            if (apart <= found.apart) continue;
            found.apart = apart;
            found.low = a.value < b.value ? i : j;
            found.high = a.value < b.value ? j : i;
        }
}

}  // namespace

Heterogeneity heterogeneity(std::span<const RecordingEstimate> recordings) {
    Heterogeneity found{};
    found.recordings = recordings.size();
    found.probability = found.added_freedom = 1.0;
    if (recordings.size() < 2) return found;
    double weights = 0.0, squares = 0.0, mean = 0.0;
    for (const RecordingEstimate& recording : recordings) {
        FIDSERVO_DEMAND(recording.std > 0.0 && recording.freedom > 0.0);
        const double w = 1.0 / (recording.std * recording.std);
        weights += w;
        squares += w * w;
        mean += w * recording.value;
    }
    mean /= weights;
    const double between = static_cast<double>(recordings.size()) - 1.0, k = between + 1.0;
    double unknown = 0.0;  // of the weights
    for (const RecordingEstimate& recording : recordings) {
        const double w = 1.0 / (recording.std * recording.std), rest = 1.0 - w / weights;
        found.q += w * (recording.value - mean) * (recording.value - mean);
        unknown += rest * rest / recording.freedom;
    }
    const double excess = 1.0 + 2.0 * (k - 2.0) / (k * k - 1.0) * unknown;
    const double below =
        unknown > 0.0 ? (k * k - 1.0) / (3.0 * unknown) : std::numeric_limits<double>::infinity();
    found.probability = mean_square_ratio_tail(found.q / between / excess, between, below);
    const double variance = std::max(0.0, (found.q / excess - between) / (weights - squares / weights));
    found.between_std = std::sqrt(variance);
    found.added_variance = variance * squares / (weights * weights);
    found.added_freedom = between;
    find_mean(recordings, found);
    find_farthest(recordings, found);
    return found;
}

void VarianceSum::add(double variance_of_it, double freedom_of_it) {
    variance += variance_of_it;
    weighted_ += variance_of_it * variance_of_it / freedom_of_it;
    freedom = weighted_ > 0.0 ? variance * variance / weighted_ : std::numeric_limits<double>::infinity();
}

}  // namespace fidservo::calib
