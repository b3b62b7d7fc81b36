// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/image_link.h"

#include "core/camera/camera_parameters.h"
#include "gap/numbers.h"
#include "plant/view/view_options.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

namespace fidservo::gap {
namespace {

constexpr double pixel_variance_px2 = 1.0 / uniform_divisor, rounding_grey2 = 1.0 / uniform_divisor;
constexpr double white_grey = 255.0;
constexpr std::size_t sides = corner_count, first_light = sides, white_noise = 2 * sides,
                      black_noise = white_noise + 1;
static_assert(black_noise + 1 == image_values);

/// Allowances for systematic errors of the measurements, as shares (tests/vision/tag_appearance_test.cpp).
constexpr double edge_allowance = 0.02, light_allowance = 2e-3, noise_allowance = 0.06;

/// The longest exposure beyond the rig file's (plant/effects/motion_blur.cpp).
constexpr double most_extra_s = 0.015;

/// Mean of the values that were measured (not NaN).
class Mean {
  public:
    void add(double value) {
        if (std::isnan(value)) return;
        sum_ += value;
        count_ += 1.0;
    }
    double of(double without_any) const { return count_ > 0.0 ? sum_ / count_ : without_any; }

  private:
    double sum_ = 0.0, count_ = 0.0;
};

/// A tag in the image, and its motion.
struct ImageMotion {
    const TagDetection* tag;
    Eigen::Vector2d velocity_px_per_s;
    double std_px_per_s;
};

/// Detections of one tag, by time.
using TagTrack = std::vector<const TagDetection*>;

Eigen::Vector2d middle_px(const TagDetection& tag) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner : tag.corners_px) sum += corner_share * corner;
    return sum;
}

/// Empty where the two frames before or after do not show the tag, or its motion is not even enough.
std::optional<ImageMotion> motion_at(const TagTrack& track, TimeNs time_ns, double frame_s) {
    constexpr double place_noise_px = 0.05, least_uncertain_share = 0.02, most_uncertain_share = hardly_any,
                     most_jump_share = small_part, noise_of_jump = 4.0;
    const auto found = std::ranges::lower_bound(track, time_ns, {}, &TagDetection::time_ns);
    if (found == track.end() || (*found)->time_ns != time_ns || found - track.begin() < 2 ||
        track.end() - found <= 2)
        return std::nullopt;
    for (auto next = found - 1; next <= found + 2; ++next)
        if (seconds((*next)->time_ns - (*(next - 1))->time_ns) > most_steps_apart * frame_s)
            return std::nullopt;
    const auto slope = [&](std::ptrdiff_t frames) -> Eigen::Vector2d {
        const TagDetection& before = **(found - frames);
        const TagDetection& after = **(found + frames);
        return (middle_px(after) - middle_px(before)) / seconds(after.time_ns - before.time_ns);
    };
    const auto turn_px = [&](std::ptrdiff_t frames) -> Eigen::Vector2d {
        return middle_px(**(found + frames)) + middle_px(**(found - frames)) - 2.0 * middle_px(**found);
    };
    // Mathematics: a slope over two frames has four times the error of one over one frame.
    const Eigen::Vector2d near = slope(1), bend = (near - slope(2)) / 3.0;
    // Mathematics: an even turn is as the square of the time.
    const double jump = (turn_px(2) - 4.0 * turn_px(1)).norm() / (2.0 * frame_s);
    const Eigen::Vector2d velocity = near + bend;
    const double speed = velocity.norm();
    if (bend.norm() > most_uncertain_share * speed + place_noise_px / frame_s ||
        jump > most_jump_share * speed + noise_of_jump * place_noise_px / frame_s)
        return std::nullopt;
    // Mathematics: three times the bend is by how much the two slopes differ.
    return ImageMotion{*found, velocity,
                       3.0 * bend.norm() + jump + place_noise_px / frame_s + least_uncertain_share * speed};
}

double edge_variance_px2(const ImageModel& model, const Eigen::Vector2d& normal,
                         const Eigen::Vector2d& velocity_px_per_s) {
    const double exposure_s = model.camera.exposure_s + model.deviation.extra_exposure_s;
    return std::pow(model.camera.blur_px, 2) + std::pow(model.deviation.extra_blur_px, 2) +
           pixel_variance_px2 + std::pow(exposure_s * normal.dot(velocity_px_per_s), 2) / uniform_divisor;
}

/// Mean light over the strip, by Gaussian quadrature with two points.
double light(const ImageModel& model, const TagSide& side) {
    const CameraGeometry& geometry = model.camera.geometry;
    plant::Light light;
    light.gradient += model.deviation.light_gradient;
    light.vignetting += model.deviation.vignetting;
    const Eigen::Vector2d half(0.5 * (geometry.width_px - 1), 0.5 * (geometry.height_px - 1));
    const Eigen::Vector2d away = side.half_strip_px / std::numbers::sqrt3;
    const auto at = [&](const Eigen::Vector2d& place_px) {
        return plant::brightness(light, (place_px - half).cwiseQuotient(half));
    };
    return 0.5 * (at(side.strip_px - away) + at(side.strip_px + away));
}

double noise_grey2(const ImageModel& model, double grey) {
    const double grey_per_e = white_grey / model.camera.full_well_e;
    const double read_e2 =
        std::pow(model.camera.read_noise_e, 2) + std::pow(model.deviation.extra_read_noise_e, 2);
    const double spread2 = std::pow(model.camera.gain_spread, 2) + std::pow(model.deviation.gain_spread, 2);
    return grey_per_e * grey + grey_per_e * grey_per_e * read_e2 + spread2 * grey * grey + rounding_grey2;
}

/// Tracks by tag.
std::map<int, TagTrack> tracks_of(const Recording& recording) {
    std::map<int, TagTrack> tracks;
    for (const TagDetection& detection : recording.detections) tracks[detection.tag_id].push_back(&detection);
    return tracks;
}

/// Logarithm of predicted over measured; NaN for a measured value that tells nothing, such as a spread of 0
/// in a strip of a single grey level.
double log_ratio(double predicted, double measured) {
    const double ratio = std::log(predicted / measured);
    return std::isfinite(ratio) ? ratio : std::numeric_limits<double>::quiet_NaN();
}

ImageSighting sighting_of(const TagAppearance& seen, const ImageMotion& motion,
                          const CameraParameters& camera, std::size_t second) {
    ImageSighting sighting{motion.tag->corners_px, motion.velocity_px_per_s, {}, 1.0, second};
    Mean expected;
    const auto floor_of = [&](double noise, double allowance) {
        const double floor = std::hypot(noise, allowance);
        // Mathematics: the mean square of an error that is uniform up to the allowance is a third of it.
        expected.add(1.0 - 2.0 / 3.0 * std::pow(allowance / floor, 2));
        return floor;
    };
    const double still_px2 = std::pow(camera.blur_px, 2) + pixel_variance_px2;
    for (std::size_t k = 0; k < sides; ++k) {
        const TagSide& side = seen.sides[k];
        // The part of the edge's variance that is due to motion: as measured, but limited to what the longest
        // possible exposure can cause, since the exposure itself is in question.
        const double along = std::abs(side.normal.dot(motion.velocity_px_per_s));
        const double longest_px = (camera.exposure_s + most_extra_s) * (along + motion.std_px_per_s);
        const double moved_px2 =
            std::clamp(side.variance_px2 - still_px2, 0.0, longest_px * longest_px / uniform_divisor);
        const double by_speed_px2 =
            along > 0.0 ? std::min(1.0, 2.0 * motion.std_px_per_s / along) * moved_px2 : 0.0;
        const double unseen_px2 = std::pow(camera.exposure_s * motion.std_px_per_s, 2) / uniform_divisor;
        sighting.floors[k] = floor_of(
            std::hypot(side.variance_std_px2, by_speed_px2 + unseen_px2) / side.variance_px2, edge_allowance);
        sighting.floors[first_light + k] = floor_of(side.white_std_grey / side.white_grey, light_allowance);
    }
    sighting.floors[white_noise] = floor_of(seen.white.std_share, noise_allowance);
    sighting.floors[black_noise] = floor_of(seen.black.std_share, noise_allowance);
    sighting.expected_square = expected.of(1.0);
    return sighting;
}

std::vector<ImageWindow> frames_of(const Recording& recording, std::span<const ImageSighting> sightings) {
    std::vector<ImageWindow> frames;
    Mean expected;
    for (std::size_t i = 0; i < recording.appearances.size(); ++i) {
        const TimeNs time_ns = recording.appearances[i].time_ns;
        if (i == 0 || time_ns != recording.appearances[i - 1].time_ns) {
            const std::size_t row = row_at(recording.rows, time_ns);
            if (i > 0) frames.back().end_row = row;
            frames.push_back({row, row + 1, i, i, 1.0});
            expected = {};
        }
        frames.back().end = i + 1;
        expected.add(sightings[i].expected_square);
        frames.back().expected_square = expected.of(1.0);
    }
    return frames;
}

}  // namespace

ImageRun image_run(Recording& recording, const CameraParameters& camera) {
    ImageRun run;
    if (recording.appearances.empty() || recording.rows.empty()) return run;
    std::map<int, TagTrack> tracks = tracks_of(recording);
    std::vector<TagAppearance> judged;
    const TimeNs first_ns = recording.rows.front().time_ns, last_ns = recording.rows.back().time_ns;
    for (const TagAppearance& seen : recording.appearances) {
        if (seen.time_ns < first_ns || seen.time_ns > last_ns) continue;
        const auto motion = motion_at(tracks[seen.tag_id], seen.time_ns, 1.0 / camera.frame_rate_hz);
        if (!motion) continue;
        judged.push_back(seen);
        const double since_s = seconds(seen.time_ns - first_ns);
        run.sightings.push_back(sighting_of(seen, *motion, camera, static_cast<std::size_t>(since_s)));
    }
    recording.appearances = std::move(judged);
    run.windows = frames_of(recording, run.sightings);
    return run;
}

std::vector<ImageErrors> image_errors(const ImageModel& model, const Recording& recording,
                                      const ImageRun& run) {
    std::vector<ImageErrors> errors;
    // The mean error of light in each second.
    std::vector<Mean> lights(run.sightings.empty() ? 0 : run.sightings.back().second + 1);
    for (std::size_t i = 0; i < run.sightings.size(); ++i) {
        const ImageSighting& sighting = run.sightings[i];
        const TagAppearance& seen = recording.appearances[i];
        Mean& of_second = lights[sighting.second];
        ImageErrors& logs = errors.emplace_back();
        for (std::size_t k = 0; k < sides; ++k) {
            const TagSide& side = seen.sides[k];
            logs[k] = log_ratio(edge_variance_px2(model, side.normal, sighting.velocity_px_per_s),
                                side.variance_px2);
            const double bright = log_ratio(white_grey * light(model, side), side.white_grey);
            logs[first_light + k] = bright;
            of_second.add(bright);
        }
        logs[white_noise] = log_ratio(noise_grey2(model, seen.white.grey), seen.white.variance_grey2);
        logs[black_noise] = log_ratio(noise_grey2(model, seen.black.grey), seen.black.variance_grey2);
    }
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const ImageSighting& sighting = run.sightings[i];
        const Mean& of_second = lights[sighting.second];
        for (std::size_t k = 0; k < sides; ++k) errors[i][first_light + k] -= of_second.of(0.0);
        for (std::size_t k = 0; k < image_values; ++k) errors[i][k] /= sighting.floors[k];
    }
    return errors;
}

}  // namespace fidservo::gap
