// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Many noisy frames of one case, and what an estimator's errors over them say.
#include "core/detection.h"
#include "tests/tag_precision/precision_case.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fidservo::precision {

struct TrialPlan {
    int shifts =
        100;         ///< places of the tag between pixels, spread evenly in u and in v, each rendered exactly
    int draws = 50;  ///< frames at each place, with noise of their own
    std::uint64_t seed = 1;
};

struct Trial {
    const cv::Mat1b& frame;
    TagDetection start;  ///< true corners, shifted together by 0.1 px and each by 0.05 px r.m.s. a coordinate
    Eigen::Vector2d truth_px;
    int shift;
};

/// The same plan gives the same frames, whoever looks at them. Only the tag and its surroundings are drawn
/// anew in every frame; what lies farther out keeps its noise for all frames at one place.
void for_each_trial(const PrecisionCase& of, const TrialPlan& plan,
                    const std::function<void(const Trial&)>& look);

struct Estimate {
    Eigen::Vector2d centre_px;
    std::optional<Eigen::Matrix2d> covariance_px2;
    std::optional<double> took_ms = std::nullopt;  ///< where another process did the work
};

using Estimator = std::function<std::optional<Estimate>(const Trial&)>;

/// The measured refinement, told what the case allows.
Estimator refinement(const PrecisionCase& of);

/// One coordinate's errors.
struct AxisFigures {
    double bound_px;
    double sigma_px, sigma_upper_px, sigma_lower_px;  ///< about the mean; 95 % limits (chi-square)
    double bias_px, bias_error_px;  ///< half width of the 95 % interval, from the places' means
    double first_harmonic_px, first_harmonic_upper_px;  ///< amplitude; 95 % limit (Rayleigh)
};

struct PrecisionFigures {
    std::string name;
    AxisFigures u = {}, v = {};
    double nees = 0.0;                       ///< mean of e' C^-1 e / 2: 1 if claims are true
    double nees_low = 0.0, nees_high = 0.0;  ///< 99 % interval of that mean for true claims
    int trials = 0;
    int failed = 0;          ///< no answer, or one that is a pixel off
    double median_ms = 0.0;  ///< of one estimate, processor time of one core
};

PrecisionFigures judge(const PrecisionCase& of, const TrialPlan& plan, const Estimator& estimator);

/// What exceeds the case's limits, one line each. `certain`: a figure is reproached only if it is above its
/// limit by more than its uncertainty; else also if it may be.
std::vector<std::string> reproaches(const PrecisionFigures& figures, const PrecisionLimits& limits,
                                    bool certain);

/// The two lines above a table, and one of its lines.
std::string table_heading();
std::string table_row(const PrecisionFigures& figures);

}  // namespace fidservo::precision
