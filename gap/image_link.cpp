#include "gap/image_link.h"

#include "core/median.h"
#include "plant/view/view_options.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace fidservo::gap {
namespace {

constexpr double pixel_variance_px2 = 1.0 / 12.0, rounding_grey2 = 1.0 / 12.0, white_grey = 255.0;
constexpr std::size_t sides = 4, first_light = sides, white_noise = 2 * sides, black_noise = white_noise + 1;
static_assert(black_noise + 1 == image_values);

/// What the measurements may be off by beyond their noise, as shares (tests/vision/tag_appearance_test.cpp).
constexpr double edge_allowance = 0.02, light_allowance = 2e-3, noise_allowance = 0.06;

/// Of an exposure beyond the rig file's (plant/effects/motion_blur.cpp).
constexpr double most_extra_s = 0.015;

/// The motion of a tag in the image.
struct ImageMotion {
    Eigen::Vector2d velocity_px_per_s;
    double std_px_per_s;
};

/// Detections of one tag, by time.
using TagTrack = std::vector<const TagDetection*>;

Eigen::Vector2d middle_px(const TagDetection& tag) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner : tag.corners_px) sum += 0.25 * corner;
    return sum;
}

/// Empty where the two frames before or after do not show the tag, or its motion is not even enough.
std::optional<ImageMotion> motion_at(const TagTrack& track, TimeNs time_ns, double frame_s) {
    constexpr double late = 1.5, place_noise_px = 0.05, least_uncertain_share = 0.02,
                     most_uncertain_share = 0.05;
    const auto found = std::ranges::lower_bound(track, time_ns, {}, &TagDetection::time_ns);
    if (found == track.end() || (*found)->time_ns != time_ns || found - track.begin() < 2 ||
        track.end() - found < 3)
        return std::nullopt;
    for (auto next = found - 1; next <= found + 2; ++next)
        if (seconds((*next)->time_ns - (*(next - 1))->time_ns) > late * frame_s) return std::nullopt;
    const auto slope = [&](std::ptrdiff_t frames) -> Eigen::Vector2d {
        const TagDetection& before = **(found - frames);
        const TagDetection& after = **(found + frames);
        return (middle_px(after) - middle_px(before)) / seconds(after.time_ns - before.time_ns);
    };
    const Eigen::Vector2d near = slope(1), bend = (near - slope(2)) / 3.0;
    const ImageMotion motion{near + bend, 3.0 * bend.norm() + place_noise_px / frame_s};
    const double speed = motion.velocity_px_per_s.norm();
    if (bend.norm() > most_uncertain_share * speed + place_noise_px / frame_s) return std::nullopt;
    return ImageMotion{motion.velocity_px_per_s, motion.std_px_per_s + least_uncertain_share * speed};
}

double edge_variance_px2(const ImageModel& model, const Eigen::Vector2d& normal,
                         const Eigen::Vector2d& velocity_px_per_s) {
    const double exposure_s = model.camera.exposure_s + model.deviation.extra_exposure_s;
    return std::pow(model.camera.blur_px, 2) + std::pow(model.deviation.extra_blur_px, 2) +
           pixel_variance_px2 + std::pow(exposure_s * normal.dot(velocity_px_per_s), 2) / 12.0;
}

/// Mean over the strip, by Gauss's two points.
double light(const ImageModel& model, const TagSide& side) {
    const CameraGeometry& geometry = model.camera.geometry;
    plant::Light light;
    light.gradient += model.deviation.light_gradient;
    light.vignetting += model.deviation.vignetting;
    const Eigen::Vector2d half(0.5 * (geometry.width_px - 1), 0.5 * (geometry.height_px - 1));
    const Eigen::Vector2d away = side.half_strip_px / std::sqrt(3.0);
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

ImageSighting sighting_of(const TagAppearance& seen, const ImageMotion& motion,
                          const CameraParameters& camera) {
    ImageSighting sighting{motion.velocity_px_per_s, {}};
    const double still_px2 = std::pow(camera.blur_px, 2) + pixel_variance_px2;
    for (std::size_t k = 0; k < sides; ++k) {
        const TagSide& side = seen.sides[k];
        // What motion adds, by what was measured and as far as any exposure can: it is what is in question.
        const double along = std::abs(side.normal.dot(motion.velocity_px_per_s));
        const double longest_px = (camera.exposure_s + most_extra_s) * (along + motion.std_px_per_s);
        const double moved_px2 =
            std::clamp(side.variance_px2 - still_px2, 0.0, longest_px * longest_px / 12.0);
        const double by_speed_px2 =
            along > 0.0 ? std::min(1.0, 2.0 * motion.std_px_per_s / along) * moved_px2 : 0.0;
        const double unseen_px2 = std::pow(camera.exposure_s * motion.std_px_per_s, 2) / 12.0;
        sighting.floors[k] = std::hypot(
            std::hypot(side.variance_std_px2, by_speed_px2 + unseen_px2) / side.variance_px2, edge_allowance);
        sighting.floors[first_light + k] = std::hypot(side.white_std_grey / side.white_grey, light_allowance);
    }
    sighting.floors[white_noise] = std::hypot(seen.white.std_share, noise_allowance);
    sighting.floors[black_noise] = std::hypot(seen.black.std_share, noise_allowance);
    return sighting;
}

}  // namespace

ImageRun image_run(Recording& recording, const CameraParameters& camera) {
    ImageRun run;
    if (recording.appearances.empty() || recording.rows.empty()) return run;
    std::map<int, TagTrack> tracks = tracks_of(recording);
    std::vector<TagAppearance> judged;
    for (const TagAppearance& seen : recording.appearances) {
        const auto motion = motion_at(tracks[seen.tag_id], seen.time_ns, 1.0 / camera.frame_rate_hz);
        if (!motion) continue;
        judged.push_back(seen);
        run.sightings.push_back(sighting_of(seen, *motion, camera));
    }
    recording.appearances = std::move(judged);
    const auto window_rows = static_cast<std::size_t>(std::lround(1.0 / recording.tick_s));
    const auto first_at = [&](std::size_t row) {
        if (row >= recording.rows.size()) return run.sightings.size();
        const auto found = std::ranges::lower_bound(recording.appearances, recording.rows[row].time_ns, {},
                                                    &TagAppearance::time_ns);
        return static_cast<std::size_t>(found - recording.appearances.begin());
    };
    for (std::size_t row = 0; row < recording.rows.size(); row += window_rows) {
        const std::size_t end_row = std::min(row + window_rows, recording.rows.size());
        const ImageWindow window{row, end_row, first_at(row), first_at(row + window_rows)};
        if (window.end > window.first) run.windows.push_back(window);
    }
    return run;
}

std::optional<double> seen_exposure_s(const Recording& recording, const ImageRun& run) {
    constexpr double least_px_per_s = 300.0;
    constexpr std::size_t fewest = 5;
    std::vector<double> exposures_s;
    for (std::size_t i = 0; i < run.sightings.size(); ++i) {
        const Eigen::Vector2d& velocity = run.sightings[i].velocity_px_per_s;
        const auto along = [&](const TagSide& side) { return std::abs(side.normal.dot(velocity)); };
        const auto [least, most] = std::ranges::minmax_element(recording.appearances[i].sides, {}, along);
        const double widened_px2 = most->variance_px2 - least->variance_px2;
        const double speeds2 = std::pow(along(*most), 2) - std::pow(along(*least), 2);
        if (!(speeds2 > std::pow(least_px_per_s, 2)) || !(widened_px2 > 0.0)) continue;
        exposures_s.push_back(std::sqrt(12.0 * widened_px2 / speeds2));
    }
    if (exposures_s.size() < fewest) return std::nullopt;
    return median_of(exposures_s);
}

std::vector<ImageErrors> image_errors(const ImageModel& model, const Recording& recording,
                                      const ImageRun& run, const ImageWindow& window) {
    std::vector<ImageErrors> errors;
    double light_sum = 0.0, weights = 0.0;
    for (std::size_t i = window.first; i < window.end; ++i) {
        const ImageSighting& sighting = run.sightings[i];
        const TagAppearance& seen = recording.appearances[i];
        ImageErrors& logs = errors.emplace_back();
        for (std::size_t k = 0; k < sides; ++k) {
            const TagSide& side = seen.sides[k];
            logs[k] = std::log(edge_variance_px2(model, side.normal, sighting.velocity_px_per_s) /
                               side.variance_px2);
            const double bright = std::log(white_grey * light(model, side) / side.white_grey);
            logs[first_light + k] = bright;
            if (std::isnan(bright)) continue;
            light_sum += bright;
            weights += 1.0;
        }
        logs[white_noise] = std::log(noise_grey2(model, seen.white.grey) / seen.white.variance_grey2);
        logs[black_noise] = std::log(noise_grey2(model, seen.black.grey) / seen.black.variance_grey2);
    }
    for (std::size_t i = 0; i < errors.size(); ++i) {
        for (std::size_t k = 0; k < sides; ++k)
            errors[i][first_light + k] -= weights > 0.0 ? light_sum / weights : 0.0;
        for (std::size_t k = 0; k < image_values; ++k)
            errors[i][k] /= run.sightings[window.first + i].floors[k];
    }
    return errors;
}

}  // namespace fidservo::gap
