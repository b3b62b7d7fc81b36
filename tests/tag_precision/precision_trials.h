// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Many noisy frames of one case, and statistics of an estimator's errors.
#include "core/detection.h"
#include "tests/tag_precision/precision_case.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::precision {

struct TrialPlan {
    /// Number of places between pixels, evenly spread in u and in v, each rendered exactly.
    int shifts = 100;
    int draws = 50;  ///< number of frames at each place, with independent noise
    std::uint64_t seed = 1;
};

struct Trial {
    const cv::Mat1b& frame;
    TagDetection start;  ///< true corners, shifted together by 0.1 px and each by 0.05 px r.m.s. a coordinate
    Eigen::Vector2d truth_px;
    int shift;
};

/// Passes all frames of a plan to an estimator. The same plan gives the same frames. Only the noise of the
/// tag and its surroundings is new in every frame; farther out it is the same in all frames at one place.
void for_each_trial(const PrecisionCase& of, const TrialPlan& plan,
                    const std::function<void(const Trial&)>& look);

struct Estimate {
    Eigen::Vector2d centre_px;
    std::optional<Eigen::Matrix2d> covariance_px2;
    std::optional<double> took_ms = std::nullopt;  ///< set if another process did the work
};

using Estimator = std::function<std::optional<Estimate>(const Trial&)>;

/// The refinement under test, with the case's prior knowledge.
Estimator refinement(const PrecisionCase& of);

/// Statistics of one coordinate's errors.
struct AxisFigures {
    double bound_px;
    double sigma_px, sigma_upper_px, sigma_lower_px;  ///< about the mean; 95 % limits (chi-square)
    /// Mean error, and the half width of its 95 % interval, from the means at the places.
    double bias_px, bias_error_px;
    double first_harmonic_px, first_harmonic_upper_px;  ///< amplitude; 95 % limit (Rayleigh)
};

struct PrecisionFigures {
    std::string name;
    AxisFigures u = {}, v = {};
    double nees = 0.0;  ///< mean of e' C^-1 e / 2, which is 1 if the stated covariances C are right
    double nees_low = 0.0, nees_high = 0.0;  ///< 99 % interval of that mean for right covariances
    int trials = 0;
    int failed = 0;          ///< frames without a result, or with one that is off by a pixel
    double median_ms = 0.0;  ///< of one estimate, processor time of one core
};

PrecisionFigures judge(const PrecisionCase& of, const TrialPlan& plan, const Estimator& estimator);

/// Lists the figures that exceed the case's limits, one line each. `certain`: only those that exceed their
/// limit by more than their uncertainty; otherwise also those that may exceed it.
std::vector<std::string> reproaches(const PrecisionFigures& figures, const PrecisionLimits& limits,
                                    bool certain);

/// The two lines above a table, and one of its lines.
std::string table_heading();
std::string table_row(const PrecisionFigures& figures);

}  // namespace fidservo::precision
