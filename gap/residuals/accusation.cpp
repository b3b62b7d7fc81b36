// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/residuals/accusation.h"

#include "gap/candidates/coupling.h"
#include "gap/fit/score.h"
#include "gap/links/tag_sight.h"
#include "gap/numbers.h"
#include "gap/residuals/false_readings.h"

#include <algorithm>
#include <cmath>

namespace fidservo::gap {
namespace {

/// What a reading displaces it displaces at rest, too: more than this share of the error along the motion.
constexpr double share_at_rest = larger_part;

std::string_view carriage_block(std::optional<Dependence> dependence) {
    if (dependence == Dependence::command || dependence == Dependence::command_share ||
        dependence == Dependence::command_change || dependence == Dependence::command_period ||
        dependence == Dependence::nothing || dependence == Dependence::time)
        return "macro.drive";
    if (dependence == Dependence::velocity || dependence == Dependence::velocity_share ||
        dependence == Dependence::direction || dependence == Dependence::position_friction ||
        dependence == Dependence::way_friction || dependence == Dependence::standing)
        return "macro.friction";
    return "macro.mechanics";
}

std::string_view platform_block(std::optional<Dependence> dependence) {
    if (dependence == Dependence::macro_command || dependence == Dependence::acceleration ||
        dependence == Dependence::platform_place || dependence == Dependence::turns_of_wire)
        return "micro.mechanics";
    if (dependence == Dependence::contraction || dependence == Dependence::contraction_before ||
        dependence == Dependence::direction || dependence == Dependence::minor_loops)
        return "micro.hysteresis";
    // A shift in time that is the same whatever the wire does is none of the wire's.
    if (dependence == Dependence::time) return "micro.hall";
    return "micro.heater";
}

/// Whether the tags are off along the stage's motion and hardly elsewhere.
bool is_displacement(const Pattern& pattern) {
    constexpr double ratio = 4.0;  // of the excess squares
    const double along = pattern.tag_along * pattern.tag_along - 1.0,
                 across = std::max(0.0, pattern.tag_across * pattern.tag_across - 1.0);
    return along > least_floors * least_floors - 1.0 && along > ratio * across;
}

std::string_view view_block(const Pattern& pattern, std::optional<Dependence> dependence) {
    if (dependence == Dependence::velocity) return "camera.timing";
    if (dependence == Dependence::position || dependence == Dependence::position_share ||
        dependence == Dependence::reading_period)
        return "macro.encoder";
    if (dependence == Dependence::contraction)
        return pattern.is_hall_right ? "camera.geometry" : "micro.hall";
    if (dependence == Dependence::image_place || dependence == Dependence::image_share)
        return "camera.geometry";
    if (dependence == Dependence::motion_by_row) return "camera.image";
    if (dependence == Dependence::plate_place || dependence == Dependence::plate_turn ||
        dependence == Dependence::tag_size || dependence == Dependence::tag_itself)
        return "plate";
    if (!is_displacement(pattern)) return "camera.geometry";
    // A time that is wrong displaces nothing that stands.
    return pattern.tag_at_rest > share_at_rest * pattern.tag_along ? "macro.encoder" : "camera.timing";
}

bool off(const Pattern& pattern, Signal signal) {
    return pattern.floors[index_of(signal)] >= least_floors;
}

/// Where a wrong model of the carriage misplaces it between two counts, the tags are off by less than this
/// share of the encoder's floors; where the encoder reads falsely, by more.
constexpr double between_counts = 2.0;

/// Whether the stages stand over a window of tags, and over the lead-in that tells where the carriage is.
bool stands(const Evidence& evidence, const Window& window) {
    const std::size_t detections = (window.end - window.begin) / corner_values;
    for (std::size_t i = 0; i < detections; ++i)
        if (!sight_of(evidence, window.run, window.first_detection + i).has_stood) return false;
    return true;
}

bool has_no_tags(const Pattern& pattern) {
    return pattern.floors[index_of(Signal::tag)] == 0.0;
}

bool tags_are_further_off(const Pattern& pattern) {
    return pattern.tag_along > between_counts * pattern.floors[index_of(Signal::encoder)];
}

bool is_hall_right_by_file(const Evidence& evidence) {
    const std::vector<Window>& windows = evidence.windows();
    const Wanted wanted = only_of(windows, everything(evidence), only(Signal::hall));
    const std::vector<double> squares = mean_squares(windows, evidence.errors({}, wanted));
    const std::vector<SignalGap> gaps = signal_gaps(evidence, squares, squares);
    const auto hall = std::ranges::find(gaps, Signal::hall, &SignalGap::signal);
    return hall != gaps.end() && !is_left(*hall);
}

}  // namespace

Pattern pattern_of(const Evidence& evidence, std::span<const SignalGap> gaps, const Errors& errors) {
    Pattern pattern;
    std::array<double, signal_count> expected{}, counts{};
    for (const Window& window : evidence.windows()) {
        expected[index_of(window.signal)] += window.expected_square;
        counts[index_of(window.signal)] += 1.0;
    }
    for (const SignalGap& gap : gaps) {
        const std::size_t s = index_of(gap.signal);
        pattern.floors[s] = gap.after / gap.floor / std::sqrt(expected[s] / counts[s]);
    }
    double along = 0.0, across = 0.0, count = 0.0, along_at_rest = 0.0, count_at_rest = 0.0;
    for (const Window& window : evidence.windows()) {
        if (window.signal != Signal::tag) continue;
        const bool is_at_rest = stands(evidence, window);
        for (std::size_t k = window.begin; k + corner_values <= window.end; k += corner_values) {
            if (std::isnan(errors[k])) continue;
            const double square = std::pow(errors[k], 2);
            along += square;
            for (std::size_t i = 1; i < corner_values; ++i) across += std::pow(errors[k + i], 2);
            count += 1.0;
            if (!is_at_rest) continue;
            along_at_rest += square;
            count_at_rest += 1.0;
        }
    }
    if (count == 0.0) return pattern;
    pattern.tag_along = std::sqrt(along / count);
    if (count_at_rest > 0.0) pattern.tag_at_rest = std::sqrt(along_at_rest / count_at_rest);
    pattern.tag_across = std::sqrt(across / (count * (corner_values - 1)));
    pattern.displacing = sensor_that_displaces_tags(evidence, errors);
    pattern.is_hall_right = is_hall_right_by_file(evidence);
    return pattern;
}

std::optional<Signal> false_sensor(const Pattern& pattern) {
    const bool is_false = pattern.displacing && is_displacement(pattern) && off(pattern, *pattern.displacing);
    return is_false ? pattern.displacing : std::nullopt;
}

bool tags_are_innocent(const Pattern& pattern) {
    return is_displacement(pattern) && off(pattern, Signal::encoder) && !false_sensor(pattern) &&
           !tags_are_further_off(pattern);
}

std::string_view accused_block(const Pattern& pattern, Signal signal, std::optional<Dependence> dependence) {
    const bool is_false = false_sensor(pattern) == signal;
    switch (signal) {
        case Signal::encoder:
            if (has_no_tags(pattern) && dependence == Dependence::reading_period) return "macro.encoder";
            return is_false ? "macro.encoder" : carriage_block(dependence);
        case Signal::hall:
            return is_false ? "micro.hall" : platform_block(dependence);
        case Signal::tag:
            return view_block(pattern, dependence);
        case Signal::image:
            return "camera.image";
        case Signal::macro_command:
        case Signal::micro_command:
            break;
    }
    return "controller";
}

Stage stage_of(std::string_view block) {
    if (block.starts_with("macro.")) return Stage::macro;
    return block.starts_with("micro.") ? Stage::micro : Stage::camera;
}

}  // namespace fidservo::gap
