// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/defect_regions.h"

#include "vision/features/normal_law.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace fidservo::vision {

namespace {

constexpr std::array scales_px{1.0, 2.0, 4.0};
/// Smoothing of the difference in which sizes are measured: little against the camera's own blur.
constexpr double size_smoothing_px = 0.7;
/// Half of the window in which a place's greatest difference is sought, and of that around significant
/// pixels.
constexpr int near_px = 5;

cv::Mat gaussian_kernel(double sigma_px) {
    return cv::getGaussianKernel(2 * static_cast<int>(std::ceil(3.5 * sigma_px)) + 1, sigma_px, CV_32F);
}

cv::Mat filtered(const cv::Mat& image, const cv::Mat& kernel) {
    cv::Mat result;
    cv::sepFilter2D(image, result, CV_32F, kernel, kernel, {-1, -1}, 0.0, cv::BORDER_REFLECT);
    return result;
}

cv::Mat disc(int radius_px) {
    return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius_px + 1, 2 * radius_px + 1});
}

/// Significant pixels and those around them that differ by more than half of the greatest difference nearby.
cv::Mat extent_of(const cv::Mat& strength, const cv::Mat& significant) {
    cv::Mat near;
    cv::Mat candidates;
    cv::dilate(strength, near, disc(near_px));
    cv::dilate(significant, candidates, disc(near_px));
    return candidates & (strength > 0.5 * near);
}

/// The longer side of the smallest rectangle around pixels, their own size included.
double length_of(const std::vector<cv::Point>& pixels) {
    const cv::Size2f box = cv::minAreaRect(pixels).size;
    return std::max(box.width, box.height) + 1.0;
}

DefectRegion region_of(const std::vector<cv::Point>& pixels, const cv::Mat& smooth,
                       const cv::Mat& significance) {
    DefectRegion region{{0.0, 0.0}, static_cast<double>(pixels.size()), length_of(pixels), 0.0, 0.0};
    double weights = 0.0;
    for (const cv::Point& pixel : pixels) {
        const double difference = smooth.at<float>(pixel);
        const double weight = std::abs(difference);
        weights += weight;
        region.centre_px += weight * cv::Point2d(pixel);
        if (weight > std::abs(region.greatest_grey)) region.greatest_grey = difference;
        region.significance = std::max<double>(region.significance, significance.at<float>(pixel));
    }
    region.centre_px *= 1.0 / weights;
    return region;
}

}  // namespace

SignificanceMap significance_of(const DifferenceImage& image, double tested_pixels, double false_alarms) {
    SignificanceMap map{cv::Mat::zeros(image.difference.size(), CV_32FC1), 0.0};
    const double tests = 2.0 * tested_pixels * static_cast<double>(scales_px.size());
    map.threshold = normal_exceeded(false_alarms / tests);
    for (const double scale : scales_px) {
        const cv::Mat kernel = gaussian_kernel(scale);
        cv::Mat std;
        cv::sqrt(filtered(image.variance, kernel.mul(kernel)), std);
        const cv::Mat beyond =
            cv::abs(filtered(image.difference, kernel)) - filtered(image.allowance, kernel);
        cv::max(map.significance, beyond / std, map.significance);
    }
    return map;
}

std::vector<DefectRegion> defect_regions(const DifferenceImage& image, const SignificanceMap& map,
                                         double least_grey, double join_px) {
    const cv::Mat smooth = filtered(image.difference, gaussian_kernel(size_smoothing_px));
    const cv::Mat strength = cv::abs(smooth);
    const cv::Mat significant = (map.significance > map.threshold) & (strength > least_grey);
    if (cv::countNonZero(significant) == 0) return {};
    const cv::Mat extent = extent_of(strength, significant) & (strength > least_grey);

    cv::Mat joined;
    cv::Mat labels;
    cv::dilate(extent, joined, disc(std::max(1, static_cast<int>(std::lround(0.5 * join_px)))));
    const int count = cv::connectedComponents(joined, labels, 8, CV_32S);
    std::vector<std::vector<cv::Point>> pixels(count);
    for (int v = 0; v < extent.rows; ++v)
        for (int u = 0; u < extent.cols; ++u)
            if (extent.at<unsigned char>(v, u) != 0) pixels[labels.at<int>(v, u)].emplace_back(u, v);

    std::vector<DefectRegion> regions;
    for (const auto& piece : pixels) {
        if (piece.empty()) continue;
        const DefectRegion region = region_of(piece, smooth, map.significance);
        if (region.significance > map.threshold) regions.push_back(region);
    }
    std::sort(regions.begin(), regions.end(),
              [](const auto& a, const auto& b) { return a.significance > b.significance; });
    return regions;
}

}  // namespace fidservo::vision
