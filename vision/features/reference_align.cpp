// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/reference_align.h"

#include "core/failure.h"

#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace fidservo::vision {

namespace {

constexpr int taps = 8;
constexpr int border_px = 8;  ///< the interpolation's reach and some: not compared
constexpr double least_overlap = 0.25;
constexpr double least_gradient_grey = 10.0;  ///< per px: an edge
constexpr double least_edges_agreeing = 0.5;
constexpr int parameters = 9;  // dx, dy, six of the light, offset
using Vector = Eigen::Matrix<double, parameters, 1>;
using Matrix = Eigen::Matrix<double, parameters, parameters>;

/// Lanczos-4 weights that read a row at `fraction` px beyond the tap before the middle, 0 <= fraction < 1.
cv::Mat lanczos_kernel(double fraction) {
    constexpr double half_taps = 0.5 * taps;
    cv::Mat kernel(1, taps, CV_32FC1);
    for (int k = 0; k < taps; ++k) {
        const double x = std::numbers::pi * (k - half_taps + 1 - fraction);
        const double weight =
            std::abs(x) < 1e-9 ? 1.0 : half_taps * std::sin(x) * std::sin(x / half_taps) / (x * x);
        kernel.at<float>(k) = static_cast<float>(weight);
    }
    return kernel / cv::sum(kernel)[0];
}

/// Where shifted() reads inside the reference.
cv::Rect covered(const cv::Size& size, const Eigen::Vector2d& shift_px) {
    const cv::Rect all(border_px, border_px, size.width - 2 * border_px, size.height - 2 * border_px);
    const cv::Point moved(-static_cast<int>(std::lround(shift_px.x())),
                          -static_cast<int>(std::lround(shift_px.y())));
    return all & (all + moved);
}

/// Place in the image from -1 to 1, and the terms of the light there.
struct LightTerms {
    Eigen::Matrix<double, 6, 1> at(int u, int v) const {
        const double x = 2.0 * u / (size.width - 1) - 1.0;
        const double y = 2.0 * v / (size.height - 1) - 1.0;
        return {1.0, x, y, x * x, x * y, y * y};
    }
    cv::Size size;
};

struct Gradient {
    cv::Mat x, y;
};
Gradient gradient_of(const cv::Mat& image) {
    Gradient gradient;
    cv::Scharr(image, gradient.x, CV_32F, 1, 0, 1.0 / 32.0);
    cv::Scharr(image, gradient.y, CV_32F, 0, 1, 1.0 / 32.0);
    return gradient;
}

struct Stage {
    double smoothing_px;
    int stride;
    int iterations;
    double tolerance_grey;  ///< added to the noise, so that what is not yet aligned counts
};

double tukey_weight(double residual, double std) {
    const double r = residual / (6.0 * std);
    return std::abs(r) < 1.0 ? (1.0 - r * r) * (1.0 - r * r) : 0.0;
}

/// Blank paper determines neither the shift nor the offset.
void add_prior(const Vector& p, const Eigen::Vector2d& start_px, double search_px, Matrix& information,
               Vector& slope) {
    const double shift_precision = 1.0 / (search_px * search_px);
    constexpr double offset_precision = 4.0;
    constexpr double light_precision = 1e4;  // quadratic terms of about 1 %
    for (int axis = 0; axis < 2; ++axis) {
        information(axis, axis) += shift_precision;
        slope[axis] += shift_precision * (start_px[axis] - p[axis]);
    }
    for (int k = 5; k < 8; ++k) {
        information(k, k) += light_precision;
        slope[k] -= light_precision * p[k];
    }
    information(8, 8) += offset_precision;
    slope[8] -= offset_precision * p[8];
}

void iterate(const cv::Mat& grey, const cv::Mat& reference, const Eigen::Vector2d& start_px, double search_px,
             const GreyNoise& noise, const Stage& stage, Vector& p) {
    const LightTerms terms{grey.size()};
    for (int iteration = 0; iteration < stage.iterations; ++iteration) {
        const cv::Mat moved = shifted(reference, p.head<2>());
        const Gradient gradient = gradient_of(moved);
        const cv::Rect valid = covered(grey.size(), p.head<2>());
        Matrix information = Matrix::Zero();
        Vector slope = Vector::Zero();
        for (int v = valid.y; v < valid.br().y; v += stage.stride)
            for (int u = valid.x; u < valid.br().x; u += stage.stride) {
                const auto light_terms = terms.at(u, v);
                const double light = light_terms.dot(p.segment<6>(2));
                const double r = moved.at<float>(v, u);
                const double residual = grey.at<float>(v, u) - light * r - p[8];
                const double std = std::sqrt(noise.variance(light * r)) + stage.tolerance_grey;
                const double weight = tukey_weight(residual, std) / (std * std);
                if (weight <= 0.0) continue;
                Vector row;
                row << light * gradient.x.at<float>(v, u), light * gradient.y.at<float>(v, u),
                    light_terms * r, 1.0;
                information.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
                slope += row * (weight * residual);
            }
        information = Matrix(information.selfadjointView<Eigen::Lower>());
        add_prior(p, start_px, search_px, information, slope);
        Vector step = information.ldlt().solve(slope);
        const double longest = step.head<2>().cwiseAbs().maxCoeff();
        constexpr double longest_step_px = 3.0;
        if (longest > longest_step_px) step.head<2>() *= longest_step_px / longest;
        p += step;
        if (longest < 1e-3) break;
    }
}

cv::Mat smoothed(const cv::Mat& image, double sigma_px) {
    cv::Mat result;
    cv::GaussianBlur(image, result, {}, sigma_px);
    return result;
}

/// The part of the reference's edges at which the image agrees with it.
double edges_agreeing(const cv::Mat& grey, const AlignedReference& aligned, const GreyNoise& noise) {
    constexpr double allowed_shift_px = 0.5;
    const Gradient gradient = gradient_of(aligned.expected);
    int edges = 0;
    int agreeing = 0;
    for (int v = aligned.valid.y; v < aligned.valid.br().y; v += 2)
        for (int u = aligned.valid.x; u < aligned.valid.br().x; u += 2) {
            const double steep = std::hypot(gradient.x.at<float>(v, u), gradient.y.at<float>(v, u));
            if (steep < least_gradient_grey) continue;
            const double expected = aligned.expected.at<float>(v, u);
            const double allowed = 6.0 * std::sqrt(noise.variance(expected)) + allowed_shift_px * steep;
            ++edges;
            agreeing += std::abs(grey.at<float>(v, u) - expected) < allowed;
        }
    return edges > 0 ? static_cast<double>(agreeing) / edges : 1.0;
}

}  // namespace

cv::Mat shifted(const cv::Mat& image, const Eigen::Vector2d& shift_px) {
    const Eigen::Vector2d whole = shift_px.array().floor();
    const Eigen::Vector2d fraction = shift_px - whole;
    cv::Mat moved;
    cv::Mat result;
    const cv::Matx23f translation(1, 0, static_cast<float>(whole.x()), 0, 1, static_cast<float>(whole.y()));
    cv::warpAffine(image, moved, translation, image.size(), cv::INTER_NEAREST | cv::WARP_INVERSE_MAP,
                   cv::BORDER_REPLICATE);
    cv::sepFilter2D(moved, result, CV_32F, lanczos_kernel(fraction.x()), lanczos_kernel(fraction.y()),
                    cv::Point(taps / 2 - 1, taps / 2 - 1), 0.0, cv::BORDER_REPLICATE);
    return result;
}

Result<AlignedReference> align_reference(const cv::Mat& grey, const cv::Mat& reference,
                                         const Eigen::Vector2d& start_px, double search_px,
                                         const GreyNoise& noise) {
    constexpr std::array stages{Stage{3.0, 4, 8, 8.0}, Stage{0.0, 2, 6, 2.0}};
    const cv::Rect overlap = covered(grey.size(), start_px);
    if (static_cast<double>(overlap.area()) < least_overlap * static_cast<double>(grey.total()))
        return failure(Reason::not_identifiable,
                       fmt::format("the reference covers {:.0f} % of the view only",
                                   100.0 * overlap.area() / static_cast<double>(grey.total())));
    Vector p = Vector::Zero();
    p.head<2>() = start_px;
    p[2] = cv::mean(grey(overlap))[0] / std::max(1.0, cv::mean(shifted(reference, start_px)(overlap))[0]);
    for (const Stage& stage : stages) {
        if (stage.smoothing_px > 0.0)
            iterate(smoothed(grey, stage.smoothing_px), smoothed(reference, stage.smoothing_px), start_px,
                    search_px, noise, stage, p);
        else
            iterate(grey, reference, start_px, search_px, noise, stage, p);
    }
    AlignedReference aligned{shifted(reference, p.head<2>()), covered(grey.size(), p.head<2>()), p.head<2>(),
                             p[2]};
    const LightTerms terms{grey.size()};
    for (int v = 0; v < grey.rows; ++v)
        for (int u = 0; u < grey.cols; ++u) {
            float& expected = aligned.expected.at<float>(v, u);
            const double level = terms.at(u, v).dot(p.segment<6>(2)) * expected + p[8];
            expected = static_cast<float>(std::clamp(level, 0.0, white_grey));
        }
    const double agreeing = edges_agreeing(grey, aligned, noise);
    const double away = (aligned.shift_px - start_px).cwiseAbs().maxCoeff();
    if (away > search_px || agreeing < least_edges_agreeing)
        return failure(
            Reason::no_convergence,
            fmt::format("not the reference's place: {:.0f} % of its edges agree at {:.1f} px shift",
                        100.0 * agreeing, away));
    return aligned;
}

}  // namespace fidservo::vision
