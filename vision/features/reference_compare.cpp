// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/reference_compare.h"

#include "core/demand.h"
#include "core/units.h"
#include "vision/features/defect_regions.h"
#include "vision/features/reference_align.h"
#include "vision/grey_noise.h"

#include <array>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

namespace fidservo::vision {

namespace {

/// A drawn reference is rounded and has no noise to even that out.
constexpr double rounding_grey = 0.5;
constexpr double paper_quantile = 0.9;

/// A high quantile of the grey levels: the paper's level.
double paper_level(const cv::Mat& grey) {
    std::array<int, 256> histogram{};
    for (int v = 0; v < grey.rows; ++v)
        for (int u = 0; u < grey.cols; ++u) ++histogram[grey.at<unsigned char>(v, u)];
    double below = 0.0;
    for (int level = 0; level < 256; ++level) {
        below += histogram[level];
        if (below >= paper_quantile * static_cast<double>(grey.total())) return level;
    }
    return white_grey;
}

/// The steepest slope within `radius_px` of every pixel, grey levels per px.
cv::Mat steepness(const cv::Mat& image, int radius_px) {
    cv::Mat x;
    cv::Mat y;
    cv::Mat slope;
    cv::Scharr(image, x, CV_32F, 1, 0, 1.0 / 32.0);
    cv::Scharr(image, y, CV_32F, 0, 1, 1.0 / 32.0);
    cv::magnitude(x, y, slope);
    cv::dilate(slope, slope,
               cv::getStructuringElement(cv::MORPH_RECT, {2 * radius_px + 1, 2 * radius_px + 1}));
    return slope;
}

DifferenceImage difference_of(const cv::Mat& grey, const AlignedReference& aligned,
                              const ReferenceImage& reference, const GreyNoise& noise, double edge_px,
                              double gain_allowance) {
    const cv::Mat& expected = aligned.expected;
    DifferenceImage image;
    const double looks = reference.noise_free ? 1.0 : 1.0 + aligned.gain * aligned.gain;
    image.variance = (expected * noise.gain_grey_per_e + noise.floor_variance) * looks;
    image.allowance = steepness(expected, static_cast<int>(std::ceil(edge_px))) * edge_px +
                      expected * gain_allowance + (reference.noise_free ? rounding_grey : 0.0);
    image.difference = cv::Mat::zeros(grey.size(), CV_32FC1);
    cv::subtract(grey(aligned.valid), expected(aligned.valid), image.difference(aligned.valid));
    return image;
}

Defect describe(const RestImage& image, const DefectRegion& region, double paper_grey) {
    const Eigen::Vector2d centre_px(region.centre_px.x, region.centre_px.y);
    const double um_per_px = um_from_mm(picture_around(image, centre_px).mm_per_px);
    const double area_um2 = region.area_px2 * um_per_px * um_per_px;
    const double length_um = region.length_px * um_per_px;
    return {to_plate(image, centre_px),
            area_um2,
            std::sqrt(4.0 * area_um2 / std::numbers::pi),
            length_um,
            area_um2 / length_um,
            region.greatest_grey > 0.0 ? DefectSign::missing_ink : DefectSign::additional_ink,
            std::abs(region.greatest_grey) / paper_grey,
            region.significance};
}

/// By how much the reference must be shifted to lie over the image: the middle's place there and here.
Eigen::Vector2d way_of_reference(const RestImage& image, const ReferenceImage& reference,
                                 const Eigen::Vector2d& middle_px) {
    RestImage from_there = image;
    from_there.axis_mm = reference.axis_mm;
    return to_image(from_there, to_plate(image, middle_px)) - middle_px;
}

}  // namespace

Result<Comparison> compare_with_reference(const RestImage& image, const ReferenceImage& reference,
                                          const CompareOptions& options) {
    FIDSERVO_DEMAND(image.grey.type() == CV_8UC1 && reference.grey.type() == CV_8UC1);
    FIDSERVO_DEMAND(image.grey.size() == reference.grey.size());
    const Eigen::Vector2d middle_px(0.5 * (image.grey.cols - 1), 0.5 * (image.grey.rows - 1));
    const double px_mm = picture_around(image, middle_px).mm_per_px;
    const GreyNoise noise = grey_noise(image.camera);
    cv::Mat grey;
    cv::Mat reference_grey;
    image.grey.convertTo(grey, CV_32F);
    reference.grey.convertTo(reference_grey, CV_32F);

    const Eigen::Vector2d start_px = way_of_reference(image, reference, middle_px);
    const auto aligned = align_reference(grey, reference_grey, start_px, options.search_px, noise);
    if (!aligned) return tl::make_unexpected(aligned.error());
    const double edge_px = mm_from_um(options.edge_allowance_um) / px_mm;
    const DifferenceImage difference =
        difference_of(grey, *aligned, reference, noise, edge_px, options.gain_allowance);
    const auto tested = static_cast<double>(aligned->valid.area());
    const SignificanceMap map = significance_of(difference, tested, options.false_alarms_per_view);

    const double paper = paper_level(image.grey);
    Comparison comparison{{},
                          map.threshold,
                          aligned->shift_px - start_px,
                          aligned->gain,
                          tested / static_cast<double>(grey.total())};
    for (const DefectRegion& region :
         defect_regions(difference, map, options.least_contrast * paper, mm_from_um(options.join_um) / px_mm))
        comparison.defects.push_back(describe(image, region, paper));
    return comparison;
}

}  // namespace fidservo::vision
