// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/tags/square_outlines.h"

#include "core/demand.h"
#include "core/median.h"
#include "vision/tags/quad.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <opencv2/imgproc.hpp>

namespace fidservo::vision {
namespace {

constexpr double least_square_side_px = 8.0;
constexpr double least_outline_contrast = 5.0;  ///< grey levels, as the thorough search asks for

using Outline = std::array<Eigen::Vector2d, 4>;

/// Grey levels on a line across a side, from `reach` px inside to as far outside, in steps of half a pixel.
std::vector<double> profile(const cv::Mat& image, const Eigen::Vector2d& at_px,
                            const Eigen::Vector2d& outward, double reach_px) {
    std::vector<double> greys;
    for (double step = -reach_px; step <= reach_px; step += 0.5) {
        const Eigen::Vector2d place = at_px + step * outward;
        if (!can_sample(image, place)) return {};
        greys.push_back(sample(image, place));
    }
    return greys;
}

/// Contrast and blur by all sides; empty unless all agree about which side of the outline is darker.
std::optional<SquareOutline> measured_outline(const cv::Mat& image, const Outline& corners) {
    constexpr int scans = 7;
    SquareOutline seen{corners, 0.0, 0.0, 0.0, false};
    for (std::size_t k = 0; k < 4; ++k) seen.side_px += 0.25 * (corners[(k + 1) % 4] - corners[k]).norm();
    const Eigen::Vector2d centre = centre_of(corners);
    const double reach_px = std::clamp(0.06 * seen.side_px, 1.5, 6.0);
    std::vector<double> blurs;
    int darker = 0, brighter = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d along = corners[(k + 1) % 4] - corners[k];
        Eigen::Vector2d outward = Eigen::Vector2d(along.y(), -along.x()).normalized();
        if (outward.dot(corners[k] - centre) < 0.0) outward = -outward;
        double contrast = 0.0;
        int seen_scans = 0;
        for (int scan = 0; scan < scans; ++scan) {
            const auto greys =
                profile(image, corners[k] + (0.15 + 0.7 * scan / (scans - 1)) * along, outward, reach_px);
            if (greys.empty()) continue;
            const double step = greys.back() - greys.front();
            double steepest = 0.0;
            for (std::size_t i = 2; i < greys.size(); ++i)
                steepest = std::max(steepest, std::abs(greys[i] - greys[i - 2]));
            if (steepest > 0.0)
                blurs.push_back(std::abs(step) / (std::sqrt(2.0 * std::numbers::pi) * steepest));
            contrast += step;
            ++seen_scans;
        }
        if (seen_scans == 0) return std::nullopt;
        contrast /= seen_scans;
        darker += contrast >= least_outline_contrast ? 1 : 0;
        brighter += contrast <= -least_outline_contrast ? 1 : 0;
        seen.contrast_grey += 0.25 * contrast;
    }
    if (darker < 4 && brighter < 4) return std::nullopt;
    if (!blurs.empty()) seen.blur_px = median_of(std::move(blurs));
    return seen;
}

bool varies_inside(const cv::Mat& image, const SquareOutline& outline) {
    constexpr int points = 14;
    constexpr double inside = 0.7, share_of_contrast = 0.25;
    const Eigen::Matrix3d homography = square_to_image(outline.corners_px);
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (int row = 0; row < points; ++row)
        for (int column = 0; column < points; ++column) {
            const Eigen::Vector2d at_px = map_point(
                homography,
                inside * Eigen::Vector2d(2.0 * column / (points - 1) - 1.0, 2.0 * row / (points - 1) - 1.0));
            if (!can_sample(image, at_px)) continue;
            const double grey = sample(image, at_px);
            sum += grey;
            squares += grey * grey;
            count += 1.0;
        }
    if (count < 0.75 * points * points) return false;
    const double deviation = std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)));
    return deviation > share_of_contrast * std::abs(outline.contrast_grey);
}

std::optional<Outline> four_corners(const std::vector<cv::Point>& contour) {
    constexpr double tolerance = 0.03;  // of the length around
    std::vector<cv::Point> corners;
    cv::approxPolyDP(contour, corners, tolerance * static_cast<double>(contour.size()), true);
    if (corners.size() != 4 || !cv::isContourConvex(corners)) return std::nullopt;
    Outline outline;
    for (std::size_t k = 0; k < 4; ++k) outline[k] = {corners[k].x, corners[k].y};
    double shortest = 1e9, longest = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        const double side = (outline[(k + 1) % 4] - outline[k]).norm();
        shortest = std::min(shortest, side);
        longest = std::max(longest, side);
    }
    constexpr double most_foreshortened = 4.0;
    if (shortest < least_square_side_px || longest > most_foreshortened * shortest) return std::nullopt;
    return outline;
}

void add_outlines(const cv::Mat& image, const cv::Mat& mask, std::vector<SquareOutline>& outlines) {
    std::vector<std::vector<cv::Point>> contours;
    cv::findContours(mask, contours, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
    for (const std::vector<cv::Point>& contour : contours) {
        if (static_cast<double>(contour.size()) < 3.0 * least_square_side_px) continue;
        const auto corners = four_corners(contour);
        if (!corners) continue;
        auto outline = measured_outline(image, *corners);
        if (!outline) continue;
        const auto is_same = [&](const SquareOutline& other) {
            const double ratio = other.side_px / outline->side_px;
            return ratio > 0.7 && ratio < 1.4 && same_place(other.corners_px, outline->corners_px);
        };
        if (std::any_of(outlines.begin(), outlines.end(), is_same)) continue;
        outline->has_pattern = varies_inside(image, *outline);
        outlines.push_back(*outline);
    }
}

}  // namespace

std::vector<SquareOutline> square_outlines(const cv::Mat& image) {
    FIDSERVO_DEMAND(image.type() == CV_8UC1);
    constexpr int least_image_px = 16;
    std::vector<SquareOutline> outlines;
    if (std::min(image.cols, image.rows) < least_image_px) return outlines;
    for (const int divisor : {6, 24}) {
        const int block = std::max(7, std::min(image.cols, image.rows) / divisor) | 1;
        for (const int type : {cv::THRESH_BINARY_INV, cv::THRESH_BINARY}) {
            cv::Mat mask;
            cv::adaptiveThreshold(
                image, mask, 255, cv::ADAPTIVE_THRESH_MEAN_C, type, block,
                type == cv::THRESH_BINARY ? -least_outline_contrast : least_outline_contrast);
            add_outlines(image, mask, outlines);
            cv::erode(mask, mask, cv::Mat());
            add_outlines(image, mask, outlines);
        }
    }
    return outlines;
}

}  // namespace fidservo::vision
