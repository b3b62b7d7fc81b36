// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/tag_precision/precision_trials.h"

#include "tests/core_time.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <Eigen/LU>
#include <fmt/format.h>

namespace fidservo::precision {
namespace {

constexpr double z95 = 1.959964, z99 = 2.575829;

/// Quantile of the chi-square distribution (Wilson and Hilferty 1931; to 1e-4 above 100 degrees of freedom).
double chi_square_quantile(double freedom, double z) {
    return freedom * std::pow(1.0 - 2.0 / (9.0 * freedom) + z * std::sqrt(2.0 / (9.0 * freedom)), 3);
}

double fraction(double x) {
    return x - std::floor(x);
}

/// A lattice with one point at each of `count` evenly spaced places in u, and also in v.
Eigen::Vector2d place_between_pixels(int k, int count) {
    const double golden = std::round(0.618034 * count);
    double stride = golden;
    while (std::gcd(static_cast<int>(stride), count) != 1) ++stride;
    return {(k + 0.25) / count, fraction((k * stride + 0.75) / count)};
}

cv::Rect surroundings(const TagScene& scene) {
    constexpr double margin_px = 12.0;
    Eigen::Vector2d low = scene.centre_px, high = low;
    for (const Eigen::Vector2d& corner : corners_of(scene)) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
    }
    const double reach = margin_px + 4.0 * scene.blur.sigma_px + scene.blur.motion_px;
    return {static_cast<int>(low.x() - reach), static_cast<int>(low.y() - reach),
            static_cast<int>(high.x() - low.x() + 2 * reach),
            static_cast<int>(high.y() - low.y() + 2 * reach)};
}

TagDetection rough(const TagScene& scene, NoiseStream& noise) {
    constexpr double common_px = 0.1, each_px = 0.05;
    TagDetection start;
    start.tag_id = scene.tag_id;
    start.decision_margin = 100.0;
    start.corners_px = corners_of(scene);
    const auto deviate = [&](double sigma) {
        const double u = sigma * noise.normal();
        return Eigen::Vector2d(u, sigma * noise.normal());
    };
    const Eigen::Vector2d common = deviate(common_px);
    for (Eigen::Vector2d& corner : start.corners_px) corner += common + deviate(each_px);
    return start;
}

/// Errors of one coordinate with the place between pixels at which each was made.
struct AxisErrors {
    std::vector<double> error_px, phase;
    std::vector<int> shift;
};

AxisFigures figures_of(const AxisErrors& errors, double bound_px, int shifts) {
    const double count = static_cast<double>(errors.error_px.size());
    std::vector<double> sums(static_cast<std::size_t>(shifts)), counts(sums.size());
    double sum = 0.0, squares = 0.0, cosine = 0.0, sine = 0.0;
    for (std::size_t k = 0; k < errors.error_px.size(); ++k) {
        sum += errors.error_px[k];
        sums[static_cast<std::size_t>(errors.shift[k])] += errors.error_px[k];
        counts[static_cast<std::size_t>(errors.shift[k])] += 1.0;
    }
    const double bias = sum / count;
    for (std::size_t k = 0; k < errors.error_px.size(); ++k) {
        const double rest = errors.error_px[k] - bias, angle = 2.0 * std::numbers::pi * errors.phase[k];
        squares += rest * rest;
        cosine += 2.0 / count * rest * std::cos(angle);
        sine += 2.0 / count * rest * std::sin(angle);
    }
    double between = 0.0, places = 0.0;
    for (std::size_t k = 0; k < sums.size(); ++k) {
        if (counts[k] == 0.0) continue;
        between += std::pow(sums[k] / counts[k] - bias, 2);
        places += 1.0;
    }
    const double sigma = std::sqrt(squares / (count - 1.0));
    constexpr double rayleigh95 = 2.447747;
    const double harmonic = std::hypot(cosine, sine);
    return {bound_px,
            sigma,
            std::sqrt(squares / chi_square_quantile(count - 1.0, -z95)),
            std::sqrt(squares / chi_square_quantile(count - 1.0, z95)),
            bias,
            z95 * std::sqrt(between / (places - 1.0) / places),
            harmonic,
            harmonic + rayleigh95 * sigma * std::sqrt(2.0 / count)};
}

}  // namespace

void for_each_trial(const PrecisionCase& of, const TrialPlan& plan,
                    const std::function<void(const Trial&)>& look) {
    for (int shift = 0; shift < plan.shifts; ++shift) {
        TagScene scene = of.scene;
        scene.centre_px += place_between_pixels(shift, plan.shifts) - Eigen::Vector2d(0.5, 0.5);
        const FrameSource source(of.sensor, mean_picture(scene));
        NoiseStream noise(plan.seed, fmt::format("{} {}", of.name, shift));
        cv::Mat1b frame;
        source.draw(noise, frame, {});
        for (int draw = 0; draw < plan.draws; ++draw) {
            source.draw(noise, frame, surroundings(scene));
            look({frame, rough(scene, noise), scene.centre_px, shift});
        }
    }
}

Estimator refinement(const PrecisionCase& of) {
    return [&of](const Trial& trial) -> std::optional<Estimate> {
        const auto refined = vision::refine_tag(trial.frame, trial.start, of.known);
        if (!refined) return std::nullopt;
        return Estimate{refined->centre_px, refined->centre_covariance_px2};
    };
}

PrecisionFigures judge(const PrecisionCase& of, const TrialPlan& plan, const Estimator& estimator) {
    PrecisionFigures figures;
    figures.name = of.name;
    AxisErrors u, v;
    double nees = 0.0;
    int claimed = 0;
    std::vector<double> times_ms;
    for_each_trial(of, plan, [&](const Trial& trial) {
        const double begin_s = core_time_s();
        const std::optional<Estimate> estimate = estimator(trial);
        const double own_ms = 1e3 * (core_time_s() - begin_s);
        times_ms.push_back(estimate && estimate->took_ms ? *estimate->took_ms : own_ms);
        ++figures.trials;
        if (!estimate || (estimate->centre_px - trial.truth_px).norm() > 1.0) {
            ++figures.failed;
            return;
        }
        const Eigen::Vector2d error = estimate->centre_px - trial.truth_px;
        for (const int axis : {0, 1}) {
            AxisErrors& errors = axis == 0 ? u : v;
            errors.error_px.push_back(error[axis]);
            errors.phase.push_back(fraction(trial.truth_px[axis]));
            errors.shift.push_back(trial.shift);
        }
        if (!estimate->covariance_px2) return;
        nees += 0.5 * error.dot(estimate->covariance_px2->inverse() * error);
        ++claimed;
    });
    const Eigen::Matrix2d bound = of.bound_px2();
    if (figures.trials - figures.failed > 2) {
        figures.u = figures_of(u, std::sqrt(bound(0, 0)), plan.shifts);
        figures.v = figures_of(v, std::sqrt(bound(1, 1)), plan.shifts);
    }
    if (claimed > 0) {
        figures.nees = nees / claimed;
        figures.nees_low = chi_square_quantile(2.0 * claimed, -z99) / (2.0 * claimed);
        figures.nees_high = chi_square_quantile(2.0 * claimed, z99) / (2.0 * claimed);
    }
    std::nth_element(times_ms.begin(), times_ms.begin() + static_cast<long>(times_ms.size() / 2),
                     times_ms.end());
    figures.median_ms = times_ms[times_ms.size() / 2];
    return figures;
}

std::vector<std::string> reproaches(const PrecisionFigures& figures, const PrecisionLimits& limits,
                                    bool certain) {
    std::vector<std::string> found;
    const auto check = [&](const std::string& what, double value, double limit) {
        if (!(value <= limit))
            found.push_back(fmt::format("{}: {} {:.6f} > {}", figures.name, what, value, limit));
    };
    if (figures.failed > 0) found.push_back(fmt::format("{}: {} failed", figures.name, figures.failed));
    for (const auto& [axis, name] : {std::pair{figures.u, "u"}, {figures.v, "v"}}) {
        const double sigma = certain ? axis.sigma_lower_px : axis.sigma_upper_px;
        check(fmt::format("sigma_{} / bound", name), sigma / axis.bound_px, limits.sigma_ratio);
        check(fmt::format("bias_{} px", name),
              std::abs(axis.bias_px) + (certain ? -axis.bias_error_px : axis.bias_error_px), limits.bias_px);
        const double spread = axis.first_harmonic_upper_px - axis.first_harmonic_px;
        check(fmt::format("first harmonic_{} px", name),
              axis.first_harmonic_px + (certain ? -spread : spread), limits.first_harmonic_px);
    }
    // 99.99 % of the samples of true claims lie within 1.5 times the 99 % interval.
    const double widened = certain ? 0.5 : 0.0;
    check("NEES / 2", figures.nees, figures.nees_high + widened * (figures.nees_high - 1.0));
    check("-NEES / 2", -figures.nees, -(figures.nees_low + widened * (figures.nees_low - 1.0)));
    return found;
}

std::string table_heading() {
    const auto line = [](auto... words) {
        return fmt::format("{:22} {:>6} {:>17} {:>17} {:>19} {:>19} {:>15} {:>15} {:>23} {:>11} {:>8}",
                           words...);
    };
    return line("case", "bound", "sigma_u / bound", "sigma_v / bound", "bias_u", "bias_v", "1st harmonic_u",
                "1st harmonic_v", "NEES / 2", "failed", "time") +
           "\n" +
           line("", "1e-3px", "(95 % limit)", "(95 % limit)", "1e-3 px (95 %)", "1e-3 px (95 %)",
                "1e-3 px (95 %)", "1e-3 px (95 %)", "(99 % interval)", "", "ms");
}

std::string table_row(const PrecisionFigures& f) {
    const bool known = f.u.bound_px > 0.0;
    const auto ratio = [&](const AxisFigures& a) {
        return known
                   ? fmt::format("{:.3f} (< {:.3f})", a.sigma_px / a.bound_px, a.sigma_upper_px / a.bound_px)
                   : "-";
    };
    const auto bias = [&](const AxisFigures& a) {
        return known ? fmt::format("{:.4f} +- {:.4f}", 1e3 * a.bias_px, 1e3 * a.bias_error_px) : "-";
    };
    const auto harmonic = [&](const AxisFigures& a) {
        return known ? fmt::format("{:.3f} (< {:.3f})", 1e3 * a.first_harmonic_px,
                                   1e3 * a.first_harmonic_upper_px)
                     : "-";
    };
    const std::string nees =
        f.nees > 0.0 ? fmt::format("{:.3f} ({:.3f} .. {:.3f})", f.nees, f.nees_low, f.nees_high) : "-";
    return fmt::format("{:22} {:6.3f} {:>17} {:>17} {:>19} {:>19} {:>15} {:>15} {:>23} {:>11} {:8.3f}",
                       f.name, 1e3 * f.u.bound_px, ratio(f.u), ratio(f.v), bias(f.u), bias(f.v),
                       harmonic(f.u), harmonic(f.v), nees, fmt::format("{}/{}", f.failed, f.trials),
                       f.median_ms);
}

}  // namespace fidservo::precision
