// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/features/line.h"

#include "core/failure.h"
#include "core/units.h"
#include "vision/features/edge_samples.h"
#include "vision/features/normal_law.h"
#include "vision/features/offset_fit.h"
#include "vision/features/subpixel_edge.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::vision {

namespace {

constexpr double line_section_px = 6.0;
constexpr double paper_px = 6.0;  ///< of paper beside the line
constexpr double least_length_px = 24.0;
constexpr double most_misfit = 0.04;  ///< residuals beyond noise as a part of the contrast: section set aside
constexpr double most_saturated_line = 0.3;
constexpr double least_part_used = 0.6;
constexpr double contrast_std = 0.02;  ///< of the ink, section against section
constexpr double blur_std_px = 0.05;   ///< of the blur, section against section

/// A straight piece of line in the image.
struct Track {
    Eigen::Vector2d from_px;
    Eigen::Vector2d to_px;
    double width_px;
    double length_px() const { return (to_px - from_px).norm(); }
    Eigen::Vector2d along() const { return (to_px - from_px).normalized(); }
    Eigen::Vector2d normal() const { return {-along().y(), along().x()}; }
};

/// One section's answer.
struct Section {
    double way_px;  ///< of its middle from the track's middle
    StripFit strip;
};

/// The part of the nominal line that is in the image with its surroundings, its ends left out.
Result<Track> visible_track(const RestImage& image, const Line& nominal, double margin_px) {
    const Eigen::Vector2d along_mm = (nominal.to_mm - nominal.from_mm).normalized();
    const LocalPicture picture =
        picture_around(image, to_image(image, 0.5 * (nominal.from_mm + nominal.to_mm)));
    Track track{to_image(image, nominal.from_mm), to_image(image, nominal.to_mm),
                nominal.width_mm * picture.px_per_mm_along({-along_mm.y(), along_mm.x()})};
    const Eigen::Vector2d along = track.along();
    const double beside = 0.5 * track.width_px + paper_px + margin_px;
    const Eigen::Vector2d inset = track.normal().cwiseAbs() * beside + Eigen::Vector2d::Constant(paper_px);
    const Eigen::Vector2d far = Eigen::Vector2d(image.grey.cols - 1.0, image.grey.rows - 1.0) - inset;
    double first = margin_px + 3.0;
    double last = track.length_px() - margin_px - 3.0;
    for (int axis = 0; axis < 2; ++axis) {
        const double start = track.from_px[axis];
        if (std::abs(along[axis]) < 1e-9) {
            if (start < inset[axis] || start > far[axis]) last = -1.0;
            continue;
        }
        const double a = (inset[axis] - start) / along[axis];
        const double b = (far[axis] - start) / along[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    if (last - first < least_length_px)
        return failure(Reason::not_identifiable,
                       fmt::format("{:.0f} px of the line are in the image; {:.0f} are needed",
                                   std::max(0.0, last - first), least_length_px));
    track.to_px = track.from_px + last * along;
    track.from_px += first * along;
    return track;
}

/// What a strip of the nominal width finds across the whole track.
struct CoarseStrip {
    double offset_px;
    double contrast;
};

/// The offset within the margin at which the mean inside the strip differs most from the means beside it.
Result<CoarseStrip> coarse_strip(const cv::Mat& grey, const Track& track, double margin_px,
                                 const SearchOptions& options) {
    const double reach = 0.5 * track.width_px + paper_px + margin_px;
    const auto samples = samples_of_band(grey, track.from_px, track.to_px, track.normal(), {reach, reach}, 1);
    const auto white = std::count_if(samples.front().begin(), samples.front().end(),
                                     [](const EdgeSample& sample) { return sample.grey >= white_grey; });
    const double white_part = static_cast<double>(white) / static_cast<double>(samples.front().size());
    if (white_part > most_saturated_line)
        return failure(Reason::glare,
                       fmt::format("{:.0f} % of the line's surroundings are saturated", 100 * white_part));
    const BinnedProfile profile = binned_profile(samples.front());
    const auto inside = static_cast<std::size_t>(std::max(2.0, std::round(track.width_px)));
    constexpr std::size_t beside = 4;
    CoarseStrip best{0.0, 0.0};
    for (std::size_t bin = beside; bin + inside + beside <= profile.grey.size(); ++bin) {
        const auto mean = [&](std::size_t first, std::size_t count) {
            double sum = 0.0;
            for (std::size_t k = first; k < first + count; ++k) sum += profile.grey[k];
            return sum / static_cast<double>(count);
        };
        const double outside = 0.5 * (mean(bin - beside, beside) + mean(bin + inside, beside));
        const double contrast = 1.0 - mean(bin, inside) / std::max(1.0, outside);
        const double offset = profile.low_px + static_cast<double>(bin) + 0.5 * static_cast<double>(inside);
        if (std::abs(offset) > margin_px + 1.0) continue;
        if (contrast / options.expected_contrast > best.contrast / options.expected_contrast)
            best = {offset, contrast};
    }
    if (best.contrast / options.expected_contrast < options.least_contrast)
        return failure(Reason::feature_not_found, fmt::format("contrast {:.2f} found, {:.2f} expected",
                                                              best.contrast, options.expected_contrast));
    return best;
}

/// The strips of all sections that can be trusted; `glaring` counts the saturated ones.
struct Strips {
    std::vector<Section> sections;
    int looked_at = 0;
    int glaring = 0;
};

Strips locate_strips(const RestImage& image, const Track& track, const StripPrior& prior) {
    const GreyNoise noise = grey_noise(image.camera);
    const double reach = 0.5 * track.width_px + paper_px;
    Strips strips;
    strips.looked_at = static_cast<int>(track.length_px() / line_section_px);
    const auto samples = samples_of_band(image.grey, track.from_px, track.to_px, track.normal(),
                                         {reach, reach}, strips.looked_at);
    for (int k = 0; k < strips.looked_at; ++k) {
        auto strip = locate_strip(samples[k], noise, prior);
        if (!strip) {
            strips.glaring += strip.error().reason == Reason::glare;
            continue;
        }
        const double ratio = strip->chi2 / std::max(1, strip->degrees_of_freedom);
        const double step = std::abs(strip->contrast) * strip->outside_grey;
        const double misfit =
            std::sqrt(std::max(0.0, ratio - 1.0) * noise.variance(strip->outside_grey - 0.5 * step)) / step;
        if (misfit > most_misfit) continue;
        const double widened = widening(std::sqrt(ratio), strip->degrees_of_freedom);
        strip->centre_std_px *= widened;
        strip->width_std_px *= widened;
        strips.sections.push_back({((k + 0.5) / strips.looked_at - 0.5) * track.length_px(), *strip});
    }
    return strips;
}

/// Fails where too little of the line was seen.
Status check_strips(const Strips& strips) {
    const double least = least_part_used * strips.looked_at;
    if (static_cast<double>(strips.sections.size()) >= least) return {};
    if (strips.glaring > 0.2 * strips.looked_at)
        return failure(Reason::glare, fmt::format("{} of {} sections of the line are saturated",
                                                  strips.glaring, strips.looked_at));
    return failure(Reason::occluded, fmt::format("only {} of {} sections of the line are seen undisturbed",
                                                 strips.sections.size(), strips.looked_at));
}

/// The straight centre line: offset at the track's middle and slope.
OffsetFit<2> centre_line(const Strips& strips) {
    std::vector<OutlineOffset<2>> offsets;
    for (const Section& section : strips.sections)
        offsets.push_back({{1.0, section.way_px}, section.strip.centre_px, section.strip.centre_std_px});
    return fit_offsets(offsets);
}

template <class Get>
double median_over(const Strips& strips, const Get& get) {
    std::vector<double> values;
    for (const Section& section : strips.sections) values.push_back(get(section.strip));
    return median_of(values);
}

/// What all sections say of blur, contrast and width: the prior of the next round.
StripPrior common_prior(const Strips& strips) {
    return {{optical_blur_px(median_over(strips, [](const StripFit& s) { return s.sigma_px; })), blur_std_px},
            0.0,
            1.0,
            median_over(strips, [](const StripFit& s) { return s.contrast; }),
            contrast_std};
}

Measured mean_width_px(const Strips& strips) {
    Measured mean;
    for (const Section& section : strips.sections) {
        mean.value += section.strip.width_px;
        mean.std += section.strip.width_std_px * section.strip.width_std_px;
    }
    const auto count = static_cast<double>(strips.sections.size());
    return {mean.value / count, std::sqrt(mean.std) / count};
}

const Section& narrowest_of(const Strips& strips) {
    return *std::min_element(
        strips.sections.begin(), strips.sections.end(),
        [](const auto& a, const auto& b) { return a.strip.width_px < b.strip.width_px; });
}

/// The least of many equal widths, measured with noise, comes out small by its standard deviation times the
/// expected greatest of as many normal values. That is put right where the narrowest section does not stand
/// out from the mean by more than chance, and the correction counts as uncertain by half of itself.
Measured narrowest_width_px(const Strips& strips, const Measured& mean_px) {
    constexpr double stands_out = 3.0;
    const StripFit& strip = narrowest_of(strips).strip;
    const double chance_px =
        expected_greatest(static_cast<double>(strips.sections.size())) * strip.width_std_px;
    if (strip.width_px + chance_px + stands_out * strip.width_std_px < mean_px.value)
        return {std::max(0.0, strip.width_px), strip.width_std_px};
    return {std::min(mean_px.value, strip.width_px + chance_px),
            std::hypot(strip.width_std_px, 0.5 * chance_px)};
}

/// Moves the track onto the centre line found.
void follow(Track& track, const OffsetFit<2>& line) {
    const Eigen::Vector2d normal = track.normal();
    const double half = 0.5 * track.length_px();
    track.from_px += (line.correction[0] - half * line.correction[1]) * normal;
    track.to_px += (line.correction[0] + half * line.correction[1]) * normal;
}

/// All that the last round found, px.
struct LineFit {
    Track track;
    Strips strips;
    OffsetFit<2> centre;
};

Result<LineFit> fit_line(const RestImage& image, Track track, const CoarseStrip& coarse) {
    constexpr int rounds = 4;
    StripPrior prior{{image.camera.blur_px, 0.3}, 0.0, 3.0, coarse.contrast, 0.2};
    for (int round = 0;; ++round) {
        Strips strips = locate_strips(image, track, prior);
        if (const auto good = check_strips(strips); !good) return tl::make_unexpected(good.error());
        auto centre = centre_line(strips);
        if (!centre.determined) return failure(Reason::occluded, "the sections found do not make a line");
        if (round + 1 == rounds) return LineFit{track, std::move(strips), std::move(centre)};
        prior = common_prior(strips);
        track.width_px = std::max(1.0, median_over(strips, [](const StripFit& s) { return s.width_px; }));
        follow(track, centre);
    }
}

LineMeasurement state(const RestImage& image, const Line& nominal, const LineFit& fit,
                      const SearchOptions& options) {
    const double widened = widening(fit.centre.excess, fit.centre.used_count - 2);
    const Eigen::Vector2d normal = fit.track.normal();
    const Eigen::Vector2d middle_px =
        0.5 * (fit.track.from_px + fit.track.to_px) + fit.centre.correction[0] * normal;
    const Eigen::Vector2d middle_mm = to_plate(image, middle_px);
    const LocalPicture picture = picture_around(image, middle_px);
    const double um_per_px = um_from_mm(picture.mm_per_px_along(normal));
    const double bend_um = bend_std_um(image, middle_px, 0.5 * (fit.track.to_px - fit.track.from_px));
    const double offset_std_um =
        std::hypot(std::sqrt(fit.centre.covariance(0, 0)) * widened * um_per_px, bend_um);
    const Eigen::Matrix2d around_mm2 = around_covariance_mm2(image, middle_px);

    const Eigen::Vector2d nominal_along = (nominal.to_mm - nominal.from_mm).normalized();
    const Eigen::Vector2d nominal_normal(-nominal_along.y(), nominal_along.x());
    const double across_std_um =
        std::hypot(offset_std_um, um_from_mm(std::sqrt(nominal_normal.dot(around_mm2 * nominal_normal))));
    const Eigen::Vector2d along = fit.track.along();

    const Measured width_px = mean_width_px(fit.strips);
    const double both_edges_um = 2.0 * options.edge_allowance_um;
    const Section& narrowest = narrowest_of(fit.strips);
    const Measured least_px = narrowest_width_px(fit.strips, width_px);

    LineMeasurement line;
    const Eigen::Vector2d arm = 0.5 * width_px.value * normal;
    const double calibration_um = calibration_std_um(image, middle_px - arm, middle_px + arm);
    line.width_um = {width_px.value * um_per_px,
                     std::hypot(width_px.std * um_per_px, both_edges_um, calibration_um)};
    line.narrowest_um = {least_px.value * um_per_px,
                         std::hypot(least_px.std * um_per_px, both_edges_um, calibration_um)};
    line.narrowest_mm = to_plate(image, 0.5 * (fit.track.from_px + fit.track.to_px) +
                                            narrowest.way_px * along + narrowest.strip.centre_px * normal);
    line.offset_um = {um_from_mm((middle_mm - nominal.from_mm).dot(nominal_normal)), across_std_um};
    line.x_um = {um_from_mm(middle_mm.x()), std::abs(nominal_normal.x()) * offset_std_um};
    line.y_um = {um_from_mm(middle_mm.y()), std::abs(nominal_normal.y()) * offset_std_um};
    line.x_um.std = std::hypot(line.x_um.std, um_from_mm(std::sqrt(around_mm2(0, 0))));
    line.y_um.std = std::hypot(line.y_um.std, um_from_mm(std::sqrt(around_mm2(1, 1))));
    const Eigen::Vector2d along_mm = picture.plate_by_image * (along + fit.centre.correction[1] * normal);
    line.angle_rad = {std::atan2(along_mm.y(), along_mm.x()),
                      std::sqrt(fit.centre.covariance(1, 1)) * widened};
    line.length_um =
        um_from_mm((to_plate(image, fit.track.to_px) - to_plate(image, fit.track.from_px)).norm());
    line.section_um = line.length_um / fit.strips.looked_at;
    line.quality = {median_over(fit.strips, [](const StripFit& s) { return s.contrast; }),
                    optical_blur_px(median_over(fit.strips, [](const StripFit& s) { return s.sigma_px; })),
                    fit.strips.looked_at, static_cast<int>(fit.strips.sections.size()), fit.centre.excess};
    return line;
}

}  // namespace

Result<LineMeasurement> measure_line(const RestImage& image, const Line& nominal,
                                     const SearchOptions& options) {
    const Eigen::Vector2d middle_px = to_image(image, 0.5 * (nominal.from_mm + nominal.to_mm));
    const double margin_px = options.margin_mm / picture_around(image, middle_px).mm_per_px;
    auto track = visible_track(image, nominal, margin_px);
    if (!track) return tl::make_unexpected(track.error());
    const auto coarse = coarse_strip(image.grey, *track, margin_px, options);
    if (!coarse) return tl::make_unexpected(coarse.error());
    const Eigen::Vector2d shift = coarse->offset_px * track->normal();
    track->from_px += shift;
    track->to_px += shift;
    const auto fit = fit_line(image, *track, *coarse);
    if (!fit) return tl::make_unexpected(fit.error());
    return state(image, nominal, *fit, options);
}

}  // namespace fidservo::vision
