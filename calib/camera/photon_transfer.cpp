// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/camera/photon_transfer.h"

#include "core/failure.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace fidservo::calib {
namespace {

constexpr double rounding = 1.0 / 12.0;
constexpr double white_grey = 255.0;
/// Grey levels whose noise is not clipped.
constexpr int darkest = 6, brightest = 238;

/// A burst's pixels without an edge near them, and their grey levels.
struct FlatPart {
    cv::Mat mask;   ///< 255 where it is flat
    cv::Mat level;  ///< mean of the neighbourhood, CV_32F: hardly a pixel's own noise is in it
};

FlatPart flat_part(const cv::Mat& mean) {
    constexpr int aperture_px = 5;
    constexpr double most_range = 12.0;
    FlatPart part;
    cv::Mat smooth, high, low;
    cv::GaussianBlur(mean, smooth, {3, 3}, 0.0);
    const cv::Mat window = cv::Mat::ones(aperture_px, aperture_px, CV_8U);
    cv::dilate(smooth, high, window);
    cv::erode(smooth, low, window);
    part.mask = high - low < most_range;
    cv::blur(mean, part.level, {aperture_px, aperture_px});
    return part;
}

cv::Mat mean_of(const std::vector<cv::Mat>& frames, std::size_t first, std::size_t step) {
    cv::Mat sum = cv::Mat::zeros(frames.front().size(), CV_32F);
    double count = 0.0;
    for (std::size_t k = first; k < frames.size(); k += step, count += 1.0) cv::accumulate(frames[k], sum);
    return sum / count;
}

/// Differences between two frames at one grey level.
struct Bin {
    double count = 0.0, levels = 0.0, squares = 0.0;
};
constexpr int bins_per_grey = 2;
using Bins = std::array<Bin, 256 * bins_per_grey>;

void add_pair(const cv::Mat& a, const cv::Mat& b, const FlatPart& flat, Bins& bins) {
    const double level_a = cv::mean(a, flat.mask)[0], level_b = cv::mean(b, flat.mask)[0];
    const double flicker = (level_b - level_a) / (0.5 * (level_b + level_a));
    for (int v = 0; v < a.rows; ++v)
        for (int u = 0; u < a.cols; ++u) {
            if (flat.mask.at<unsigned char>(v, u) == 0) continue;
            const double level = flat.level.at<float>(v, u);
            Bin& bin = bins[static_cast<std::size_t>(bins_per_grey * level)];
            const double difference = b.at<unsigned char>(v, u) - a.at<unsigned char>(v, u) - flicker * level;
            bin.count += 1.0;
            bin.levels += level;
            bin.squares += difference * difference;
        }
}

/// Points of at least so many pixels: grey levels are put together until they are there.
std::vector<TransferPoint> points_of(const Bins& bins) {
    constexpr double enough_pixels = 2000.0;
    constexpr int widest = 8 * bins_per_grey;
    std::vector<TransferPoint> points;
    Bin together;
    int width = 0;
    for (int k = darkest * bins_per_grey; k < brightest * bins_per_grey; ++k) {
        const Bin& bin = bins[static_cast<std::size_t>(k)];
        together.count += bin.count;
        together.levels += bin.levels;
        together.squares += bin.squares;
        if (++width < widest && together.count < enough_pixels) continue;
        if (together.count >= enough_pixels) {
            const double variance = 0.5 * together.squares / together.count;
            points.push_back(
                {together.levels / together.count, variance, variance * std::sqrt(2.0 / together.count)});
        }
        together = {};
        width = 0;
    }
    return points;
}

struct Line {
    Eigen::Vector2d value;  ///< slope, floor
    Eigen::Matrix2d covariance;
    double misfit;
};

/// Weighted by the variances' own scatter at the modelled variance, in a few rounds; the points take it over.
Line fit_transfer_line(std::vector<TransferPoint>& points) {
    constexpr int rounds = 4;
    std::vector<double> relative_std;
    relative_std.reserve(points.size());
    for (const TransferPoint& point : points) relative_std.push_back(point.variance_std / point.variance);
    Line line{};
    for (int round = 0; round < rounds; ++round) {
        Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
        Eigen::Vector2d right = Eigen::Vector2d::Zero();
        for (const TransferPoint& point : points) {
            const Eigen::Vector2d terms(point.mean_grey, 1.0);
            const double weight = 1.0 / (point.variance_std * point.variance_std);
            normal += weight * terms * terms.transpose();
            right += weight * point.variance * terms;
        }
        line.covariance = normal.inverse();
        line.value = line.covariance * right;
        line.misfit = 0.0;
        for (std::size_t k = 0; k < points.size(); ++k) {
            const double modelled = line.value(0) * points[k].mean_grey + line.value(1);
            points[k].variance_std = relative_std[k] * std::max(modelled, rounding);
            line.misfit += std::pow((modelled - points[k].variance) / points[k].variance_std, 2) /
                           std::max(1.0, static_cast<double>(points.size()) - 2.0);
        }
    }
    return line;
}

/// Sums over triples of neighbours that do not overlap.
struct Pattern {
    double common = 0.0, scatter = 0.0, level = 0.0;  ///< products, their squares, 6 mean^2

    void add(const cv::Mat& even, const cv::Mat& odd, const cv::Mat& flat) {
        for (int v = 0; v < even.rows; ++v)
            for (int u = 1; u + 1 < even.cols; u += 3) {
                const float mean = even.at<float>(v, u);
                if (flat.at<unsigned char>(v, u) == 0 || mean < darkest || mean > brightest) continue;
                const auto bend = [&](const cv::Mat& of) {
                    return of.at<float>(v, u - 1) - 2.0 * of.at<float>(v, u) + of.at<float>(v, u + 1);
                };
                const double product = bend(even) * bend(odd);
                common += product;
                scatter += product * product;
                level += 6.0 * mean * mean;
            }
    }
};

}  // namespace

Result<PhotonTransfer> measure_noise(const std::vector<std::vector<cv::Mat>>& bursts) {
    constexpr std::size_t least_points = 4;
    Bins bins{};
    Pattern pattern;
    for (const std::vector<cv::Mat>& burst : bursts) {
        if (burst.size() < 2) continue;
        const FlatPart flat = flat_part(mean_of(burst, 0, 1));
        for (std::size_t k = 0; k + 1 < burst.size(); k += 2) add_pair(burst[k], burst[k + 1], flat, bins);
        pattern.add(mean_of(burst, 0, 2), mean_of(burst, 1, 2), flat.mask);
    }
    std::vector<TransferPoint> points = points_of(bins);
    if (points.size() < least_points)
        return failure(Reason::not_identifiable,
                       "too few pixels away from edges and from black and white for the camera's noise");
    const Line line = fit_transfer_line(points);
    const double widen = std::max(1.0, line.misfit);
    const double slope = line.value(0);
    const double slope_std = std::sqrt(widen * line.covariance(0, 0));
    constexpr double most_relative_std = 0.2;
    if (!(slope_std < most_relative_std * slope))
        return failure(
            Reason::not_identifiable,
            fmt::format("how the noise grows with the grey level is not known to {:.0f} %: {:.2g} +- {:.2g} "
                        "grey levels squared per level, from levels of {:.0f} to {:.0f}",
                        100.0 * most_relative_std, slope, slope_std, points.front().mean_grey,
                        points.back().mean_grey));
    const double floor = line.value(1) - rounding;
    const double floor_std = std::sqrt(widen * line.covariance(1, 1));
    PhotonTransfer result{};
    result.full_well_e = white_grey / slope;
    result.full_well_std_e = result.full_well_e * slope_std / slope;
    result.read_noise_e = std::sqrt(std::max(0.0, floor)) / slope;
    // r = sqrt(floor) / slope; about zero, where the root has no slope, no more than the root of the error.
    const double root = std::sqrt(std::max(floor, 1e-12));
    const Eigen::Vector2d by_line(-root / (slope * slope), 1.0 / (2.0 * root * slope));
    result.read_noise_std_e =
        std::min(std::sqrt(widen * by_line.dot(line.covariance * by_line)), std::sqrt(floor_std) / slope);
    const double spread2 = pattern.level > 0.0 ? pattern.common / pattern.level : 0.0;
    const double spread2_std = pattern.level > 0.0 ? std::sqrt(pattern.scatter) / pattern.level : 0.0;
    const bool seen = spread2 > 2.0 * spread2_std;
    result.gain_spread = seen ? std::sqrt(spread2) : 0.0;
    result.gain_spread_std = seen ? spread2_std / (2.0 * result.gain_spread) : std::sqrt(spread2_std);
    result.points = std::move(points);
    result.misfit = line.misfit;
    return result;
}

}  // namespace fidservo::calib
