// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/subpixel_edge.h"

#include "core/failure.h"
#include "vision/features/profile_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/format.h>

namespace fidservo::vision {

namespace {

constexpr double pixel_variance_px2 = 1.0 / 12.0;
constexpr double least_sigma_px = 0.3;
constexpr double most_sigma_px = 4.0;
constexpr double least_contrast_grey = 3.0;
/// Above this level a third of the pixels are clipped, and the level is hardly seen.
constexpr double saturated_grey = white_grey - 0.5;

double precision(double std) {
    return std > 0.0 ? 1.0 / (std * std) : 1e12;
}

struct Extent {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    double middle() const { return 0.5 * (low + high); }
    double length() const { return high - low; }
};

Extent along_edge(std::span<const EdgeSample> samples) {
    Extent extent;
    for (const EdgeSample& sample : samples) {
        extent.low = std::min(extent.low, sample.t_px);
        extent.high = std::max(extent.high, sample.t_px);
    }
    return extent;
}

/// Mean grey of the samples with low <= t <= high; empty ones give 0.
double mean_grey(std::span<const EdgeSample> samples, double low, double high) {
    double sum = 0.0;
    int count = 0;
    for (const EdgeSample& sample : samples) {
        if (sample.t_px < low || sample.t_px > high) continue;
        sum += sample.grey;
        ++count;
    }
    return count > 0 ? sum / count : 0.0;
}

}  // namespace

double edge_sigma_px(double blur_px) {
    return std::sqrt(blur_px * blur_px + pixel_variance_px2);
}

double optical_blur_px(double sigma_px) {
    return std::sqrt(std::max(0.0, sigma_px * sigma_px - pixel_variance_px2));
}

Result<EdgeFit> locate_edge(std::span<const EdgeSample> samples, const GreyNoise& noise,
                            const BlurPrior& blur) {
    constexpr std::size_t parameters = 4;
    using Vector = Eigen::Vector4d;  // position, low side, high side, sigma
    const Extent extent = along_edge(samples);
    if (samples.size() < 3 * parameters || extent.length() < 3.0)
        return failure(Reason::not_identifiable,
                       fmt::format("{} pixels across an edge are too few", samples.size()));

    const double quarter = 0.25 * extent.length();
    const double low = mean_grey(samples, extent.low, extent.low + quarter);
    const double high = mean_grey(samples, extent.high - quarter, extent.high);
    if (std::abs(high - low) < least_contrast_grey)
        return failure(Reason::not_identifiable,
                       fmt::format("no edge: the levels differ by {:.1f}", high - low));

    const double sigma = edge_sigma_px(blur.blur_px);
    const Vector start(extent.middle(), low, high, sigma);
    const ProfilePrior<4> prior{start, Vector(0.0, 0.0, 0.0, precision(blur.std_px))};
    const auto model = [](double t, const Vector& p) {
        const double z = (t - p[0]) / p[3];
        const double step = normal_cdf(z);
        const double slope = (p[2] - p[1]) * normal_density(z) / p[3];
        return ProfileModelValue<4>{p[1] + (p[2] - p[1]) * step, {-slope, 1.0 - step, step, -slope * z}};
    };
    const auto clamp = [](Vector p) {
        p[3] = std::clamp(p[3], least_sigma_px, most_sigma_px);
        return p;
    };
    const auto fit = fit_profile<4>(samples, noise, start, prior, Vector(1.0, 50.0, 50.0, 0.3), model, clamp);
    if (!fit.converged) return failure(Reason::no_convergence, "the edge profile does not fit");
    const Vector& p = fit.parameters;
    if (std::max(p[1], p[2]) > saturated_grey) return failure(Reason::glare, "the edge is saturated");
    if (p[0] < extent.low + sigma || p[0] > extent.high - sigma ||
        std::abs(p[2] - p[1]) < least_contrast_grey)
        return failure(Reason::not_identifiable, "no edge within the pixels looked at");
    return EdgeFit{p[0],
                   std::sqrt(fit.covariance(0, 0)),
                   p[1],
                   p[2],
                   p[3],
                   fit.chi2,
                   static_cast<int>(samples.size() - parameters)};
}

Result<StripFit> locate_strip(std::span<const EdgeSample> samples, const GreyNoise& noise,
                              const StripPrior& prior) {
    constexpr std::size_t parameters = 6;
    using Vector = Eigen::Matrix<double, parameters, 1>;  // centre, width, level, slope, contrast, sigma
    const Extent extent = along_edge(samples);
    if (samples.size() < 3 * parameters || extent.length() < 5.0)
        return failure(Reason::not_identifiable,
                       fmt::format("{} pixels across a line are too few", samples.size()));

    const double level = 0.5 * (mean_grey(samples, extent.low, extent.low + 2.0) +
                                mean_grey(samples, extent.high - 2.0, extent.high));
    const double dark_px = (1.0 - mean_grey(samples, extent.low, extent.high) / level) * extent.length();
    Vector start;
    start << prior.centre_px, std::max(0.2, dark_px / prior.contrast), level, 0.0, prior.contrast,
        edge_sigma_px(prior.blur.blur_px);
    Vector known;
    known << precision(prior.centre_std_px), 0.0, 0.0, 0.0, precision(prior.contrast_std),
        precision(prior.blur.std_px);
    const auto model = [](double t, const Vector& p) {
        const double za = (t - p[0] + 0.5 * p[1]) / p[5];
        const double zb = (t - p[0] - 0.5 * p[1]) / p[5];
        const double covered = normal_cdf(za) - normal_cdf(zb);
        const double da = normal_density(za) / p[5];
        const double db = normal_density(zb) / p[5];
        const double outside = p[2] + p[3] * t;
        const double light = 1.0 - p[4] * covered;
        const double depth = -outside * p[4];
        ProfileModelValue<parameters> value{outside * light, {}};
        value.gradient << depth * (db - da), depth * 0.5 * (da + db), light, t * light, -outside * covered,
            depth * (zb * db - za * da);
        return value;
    };
    const auto clamp = [](Vector p) {
        p[5] = std::clamp(p[5], least_sigma_px, most_sigma_px);
        return p;
    };
    Vector bound;
    bound << 1.0, 1.5, 50.0, 2.0, 0.2, 0.3;
    const auto fit = fit_profile<parameters>(samples, noise, start, {start, known}, bound, model, clamp);
    if (!fit.converged) return failure(Reason::no_convergence, "the line's profile does not fit");
    const Vector& p = fit.parameters;
    if (std::max(p[2], p[2] * (1.0 - p[4])) > saturated_grey)
        return failure(Reason::glare, "the line is saturated");
    return StripFit{p[0],
                    std::sqrt(fit.covariance(0, 0)),
                    p[1],
                    std::sqrt(fit.covariance(1, 1)),
                    p[2],
                    p[4],
                    p[5],
                    fit.chi2,
                    static_cast<int>(samples.size() - parameters)};
}

}  // namespace fidservo::vision
