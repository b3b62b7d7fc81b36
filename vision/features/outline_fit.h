// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Fits a shape's outline to the edge measured along it: the common part of dots, pads and single edges.
#include "core/failure.h"
#include "core/result.h"
#include "vision/features/edge_samples.h"
#include "vision/features/offset_fit.h"
#include "vision/features/rest_image.h"
#include "vision/features/subpixel_edge.h"

#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>
#include <fmt/format.h>

namespace fidservo::vision {

/// A section of an outline: the pixels along it, and how the shape's parameters move it along its normal.
template <int N>
struct OutlineSection {
    EdgeSamples samples;
    Eigen::Matrix<double, N, 1> row;
};

template <class Shape>
struct OutlineFit {
    Shape shape;
    Eigen::Matrix<double, Shape::parameters, Shape::parameters> covariance_px2;  ///< of Shape's parameters
    EdgeQuality quality;
};

/// How far from the edge pixels are used for its fine location: five standard deviations of the profile.
inline constexpr double fine_reach_px = 4.5;

namespace outline_detail {

/// A section is left out if its profile deviates from the model by more than this fraction of the contrast,
/// noise deducted.
inline constexpr double most_misfit = 0.04;
/// Standard deviation in px of a coarse edge position.
inline constexpr double coarse_std_px = 1.0;
/// The least fraction of the outline's sections that must be usable for a result.
inline constexpr double least_part_used = 0.6;
/// An edge that scatters more than this around the outline does not have the shape's form.
inline constexpr double most_form_error_px = 1.5;

/// The largest ratio of a parameter's variance with the usable sections to that with the whole outline.
inline constexpr double most_hidden_variance = 1.5;

template <class Shape>
using Information = Eigen::Matrix<double, Shape::parameters, Shape::parameters>;

/// The largest ratio of a parameter's variance with the sections used to that with all of them.
template <class Shape>
double hidden_variance(const Information<Shape>& of_all, const Information<Shape>& of_used) {
    return of_used.inverse().diagonal().cwiseQuotient(of_all.inverse().diagonal()).maxCoeff();
}

struct LocatedEdge {
    double offset_px;
    double std_px;
    double contrast;  ///< 1 - inside / outside level
    double sigma_px;
};

/// Locates the edge in one section; its uncertainty is widened by the profile's misfit. Fails as
/// locate_edge() does, or with occluded.
inline Result<LocatedEdge> locate_outline(const EdgeSamples& samples, const GreyNoise& noise,
                                          const BlurPrior& blur) {
    const auto edge = locate_edge(samples, noise, blur);
    if (!edge) return tl::make_unexpected(edge.error());
    const double step = std::abs(edge->high_side_grey - edge->low_side_grey);
    const double ratio = edge->chi2 / std::max(1, edge->degrees_of_freedom);
    const double variance = noise.variance(0.5 * (edge->high_side_grey + edge->low_side_grey));
    const double misfit = std::sqrt(std::max(0.0, ratio - 1.0) * variance) / step;
    if (misfit > most_misfit) return failure(Reason::occluded, "the edge's profile is disturbed");
    const double widened = widening(std::sqrt(ratio), edge->degrees_of_freedom);
    return LocatedEdge{edge->position_px, edge->position_std_px * widened,
                       1.0 - edge->low_side_grey / std::max(1.0, edge->high_side_grey), edge->sigma_px};
}

/// One iteration: locates the edge in all sections and corrects the shape by `step` times the fitted change.
template <class Shape>
Result<OffsetFit<Shape::parameters>> correct_once(const cv::Mat& grey, Shape& shape, const GreyNoise& noise,
                                                  const BlurPrior& blur, const SearchOptions& options,
                                                  double step, EdgeQuality& quality) {
    std::vector<OutlineOffset<Shape::parameters>> offsets;
    Information<Shape> of_all = Information<Shape>::Zero();
    Information<Shape> of_used = Information<Shape>::Zero();
    std::vector<double> contrasts;
    std::vector<double> sigmas;
    int glaring = 0;
    const auto sections = shape.sections(grey, {fine_reach_px, fine_reach_px});
    for (const auto& section : sections) {
        of_all.noalias() += section.row * section.row.transpose();
        const auto edge = locate_outline(section.samples, noise, blur);
        if (!edge) {
            glaring += edge.error().reason == Reason::glare;
            continue;
        }
        if (edge->contrast / options.expected_contrast < options.least_contrast) continue;
        offsets.push_back({section.row, edge->offset_px, edge->std_px});
        contrasts.push_back(edge->contrast);
        sigmas.push_back(edge->sigma_px);
    }
    quality.sections = static_cast<int>(sections.size());
    quality.sections_used = static_cast<int>(offsets.size());
    const double least = least_part_used * static_cast<double>(sections.size());
    if (quality.sections_used < least && glaring > 0.2 * static_cast<double>(sections.size()))
        return failure(Reason::glare,
                       fmt::format("{} of {} sections of the edge are saturated", glaring, quality.sections));
    auto fit = fit_offsets(offsets);
    quality.sections_used = fit.used_count;
    if (!fit.determined || quality.sections_used < least)
        return failure(Reason::occluded,
                       fmt::format("only {} of {} sections of the edge are seen undisturbed",
                                   quality.sections_used, quality.sections));
    for (std::size_t k = 0; k < offsets.size(); ++k)
        if (fit.used[k]) of_used.noalias() += offsets[k].row * offsets[k].row.transpose();
    if (hidden_variance<Shape>(of_all, of_used) > most_hidden_variance)
        return failure(Reason::occluded, "a whole side of the outline is not seen undisturbed");
    quality.contrast = median_of(contrasts);
    quality.blur_px = optical_blur_px(median_of(sigmas));
    quality.excess = fit.excess;
    shape.correct(step * fit.correction);
    return fit;
}

}  // namespace outline_detail

/// Moves a shape whose place is known to within `reach_px` onto the strongest steps of the expected sign.
/// @param paper_grey  level around the feature, to which the expected contrast refers
/// Fails with feature_not_found (hardly any such edge) or occluded (too little of it).
template <class Shape>
Status find_outline(const cv::Mat& grey, Shape& shape, double reach_px, double paper_grey,
                    const SearchOptions& options) {
    constexpr int rounds = 2;
    const double sign = options.expected_contrast > 0.0 ? 1.0 : -1.0;
    const double least_grey = options.least_contrast * std::abs(options.expected_contrast) * paper_grey;
    for (int round = 0; round < rounds; ++round) {
        std::vector<OutlineOffset<Shape::parameters>> offsets;
        const double reach = round == 0 ? reach_px : std::min(reach_px, 2.0 * fine_reach_px);
        const auto sections = shape.sections(grey, {reach, reach});
        for (const auto& section : sections)
            if (const auto step = coarse_step_px(section.samples, sign, least_grey))
                offsets.push_back({section.row, *step, outline_detail::coarse_std_px});
        const double part = static_cast<double>(offsets.size()) / static_cast<double>(sections.size());
        if (part < 0.5)
            return failure(
                part < 0.2 ? Reason::feature_not_found : Reason::occluded,
                fmt::format("an edge of the expected contrast in {:.0f} % of the outline only", 100 * part));
        const auto fit = fit_offsets(offsets);
        if (!fit.determined) return failure(Reason::occluded, "the edges found do not make the shape");
        shape.correct(fit.correction);
    }
    return {};
}

/// Locates the outline finely. Shape must have `parameters`, `sections(grey, Reach)` and
/// `correct(correction)`. Fails with occluded, glare, no_convergence.
template <class Shape>
Result<OutlineFit<Shape>> fit_outline(const RestImage& image, Shape shape, const SearchOptions& options) {
    constexpr int most_rounds = 8;
    // Largest last correction, in standard deviations. Pixels that enter and leave a section can make the fit
    // oscillate.
    constexpr double at_rest = 0.2;
    constexpr double still_at_rest = 1.0;
    constexpr int full_rounds = 4;  // half steps after these damp an oscillation
    const GreyNoise noise = grey_noise(image.camera);
    const BlurPrior blur{image.camera.blur_px, 0.3};
    EdgeQuality quality;
    for (int round = 0; round < most_rounds; ++round) {
        const auto fit = outline_detail::correct_once(image.grey, shape, noise, blur, options,
                                                      round < full_rounds ? 1.0 : 0.5, quality);
        if (!fit) return tl::make_unexpected(fit.error());
        const auto std = fit->covariance.diagonal().cwiseSqrt();
        const double move = fit->correction.cwiseQuotient(std).cwiseAbs().maxCoeff();
        if (move > (round + 1 < most_rounds ? at_rest : still_at_rest)) continue;
        const double widened = widening(fit->excess, fit->used_count - Shape::parameters);
        return OutlineFit<Shape>{shape, fit->covariance * widened * widened, quality};
    }
    return failure(Reason::no_convergence, "the outline does not come to rest");
}

}  // namespace fidservo::vision
