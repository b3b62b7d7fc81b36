// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/coarse_search.h"

#include "core/failure.h"

#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace fidservo::vision {

namespace {

constexpr double ring_px = 4.0;  ///< paper around the shape that belongs to the template
constexpr double least_score = 0.5;
constexpr double most_saturated_template = 0.3;
constexpr double rival_score = 0.9;  ///< of the best score

/// The part of an image that reads white or next to it.
double saturated_part(const cv::Mat& grey) {
    return static_cast<double>(cv::countNonZero(grey >= 255)) / static_cast<double>(grey.total());
}

struct Template {
    cv::Mat coverage;  ///< CV_32FC1
    cv::Point centre;
};

Template draw_template(const Eigen::Vector2d& half_size_px,
                       const std::function<double(double, double)>& coverage) {
    const cv::Point half(static_cast<int>(std::ceil(half_size_px.x() + ring_px)),
                         static_cast<int>(std::ceil(half_size_px.y() + ring_px)));
    Template drawn{cv::Mat(2 * half.y + 1, 2 * half.x + 1, CV_32FC1), half};
    for (int v = 0; v < drawn.coverage.rows; ++v)
        for (int u = 0; u < drawn.coverage.cols; ++u)
            drawn.coverage.at<float>(v, u) = static_cast<float>(coverage(u - half.x, v - half.y));
    return drawn;
}

/// Levels outside and inside by least squares of the window on the coverage.
struct Levels {
    double outside;
    double inside;
};
Levels levels_in(const cv::Mat& window, const cv::Mat& coverage) {
    cv::Mat grey;
    window.convertTo(grey, CV_32F);
    const double n = static_cast<double>(grey.total());
    const double c = cv::sum(coverage)[0] / n;
    const double g = cv::sum(grey)[0] / n;
    const double slope = (coverage.dot(grey) / n - c * g) / (coverage.dot(coverage) / n - c * c);
    return {g - slope * c, g - slope * c + slope};
}

/// The best score farther than the shape's own extent from the best place.
double best_rival(const cv::Mat& scores, cv::Point best, const Eigen::Vector2d& half_size_px) {
    const cv::Size own(static_cast<int>(half_size_px.x()), static_cast<int>(half_size_px.y()));
    const cv::Rect taken(best - cv::Point(own), own * 2);
    cv::Mat others = scores.clone();
    others(taken & cv::Rect(cv::Point(0, 0), scores.size())).setTo(-1.0);
    double rival = 0.0;
    cv::minMaxLoc(others, nullptr, &rival);
    return rival;
}

}  // namespace

Result<CoarseMatch> find_shape(const RestImage& image, const Eigen::Vector2d& nominal_px,
                               const Eigen::Vector2d& half_size_px,
                               const std::function<double(double, double)>& coverage,
                               const SearchOptions& options) {
    const cv::Rect all(0, 0, image.grey.cols, image.grey.rows);
    const Eigen::Vector2d low = nominal_px - half_size_px;
    const Eigen::Vector2d high = nominal_px + half_size_px;
    if (low.minCoeff() < 0.0 || high.x() > all.width - 1.0 || high.y() > all.height - 1.0)
        return failure(Reason::not_identifiable,
                       fmt::format("the nominal place ({:.0f}, {:.0f}) px is partly outside the image",
                                   nominal_px.x(), nominal_px.y()));
    const Template drawn = draw_template(half_size_px, coverage);
    const int margin =
        static_cast<int>(std::ceil(options.margin_mm / picture_around(image, nominal_px).mm_per_px));
    const cv::Point nominal(static_cast<int>(std::lround(nominal_px.x())),
                            static_cast<int>(std::lround(nominal_px.y())));
    const cv::Rect region = cv::Rect(nominal - drawn.centre - cv::Point(margin, margin),
                                     drawn.coverage.size() + cv::Size(2 * margin, 2 * margin)) &
                            all;
    if (region.width < drawn.coverage.cols || region.height < drawn.coverage.rows)
        return failure(Reason::not_identifiable,
                       "the shape with its surroundings does not fit into the image");

    if (saturated_part(image.grey(region)) > most_saturated_template)
        return failure(Reason::glare, fmt::format("{:.0f} % of the search region are saturated",
                                                  100.0 * saturated_part(image.grey(region))));
    const double sign = options.expected_contrast > 0.0 ? -1.0 : 1.0;
    cv::Mat window;
    cv::Mat scores;
    image.grey(region).convertTo(window, CV_32F, sign);
    cv::matchTemplate(window, drawn.coverage, scores, cv::TM_CCOEFF_NORMED);
    double score = 0.0;
    cv::Point best;
    cv::minMaxLoc(scores, nullptr, &score, nullptr, &best);

    const Levels levels =
        levels_in(image.grey(cv::Rect(region.tl() + best, drawn.coverage.size())), drawn.coverage);
    const double contrast = 1.0 - levels.inside / std::max(1.0, levels.outside);
    if (score < least_score || contrast / options.expected_contrast < options.least_contrast)
        return failure(
            Reason::feature_not_found,
            fmt::format("contrast {:.2f} found, {:.2f} expected; likeness {:.2f}, at least {:.2f} expected",
                        contrast, options.expected_contrast, score, least_score));
    if (best_rival(scores, best, half_size_px) > rival_score * score)
        return failure(Reason::not_identifiable, "two places within the search margin look alike");
    const cv::Point centre = region.tl() + best + drawn.centre;
    return CoarseMatch{Eigen::Vector2d(centre.x, centre.y), score, contrast, levels.outside};
}

}  // namespace fidservo::vision
