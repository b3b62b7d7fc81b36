// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Steps of an integration that end at an event.
#include <optional>

namespace fidservo::plant {

/// Steps are no shorter than this, in s.
inline constexpr double shortest_step_s = 1e-10;

/// The shortest step found that ends just past an event, by regula falsi on the slack (Illinois: an end that
/// stays counts half).
/// @param slack_at_start  how far from the event the steps begin; if it is past or at it, the event is one
///                        that the motion leaves for the next within the step
/// @param late  a step, of .duration_s, that ends past the event
/// @param step_of  the step of a duration in s
/// @param slack_of  how far from the event a step ends, negative past it
template <class Step, class StepOf, class SlackOf>
Step step_to_event(double slack_at_start, Step late, const StepOf& step_of, const SlackOf& slack_of) {
    double early_s = 0.0, early_slack = slack_at_start, late_slack = slack_of(late);
    while (early_slack <= 0.0) {
        if (late.duration_s < shortest_step_s) return late;
        const Step step = step_of(0.25 * late.duration_s);
        const double value = slack_of(step);
        if (value > 0.0) {
            early_s = step.duration_s;
            early_slack = value;
        } else {
            late = step;
            late_slack = value;
        }
    }
    constexpr double resolution = 1e-10, resolution_s = 1e-14;
    double early_weight = early_slack, late_weight = late_slack;
    std::optional<bool> was_late;
    while (late_slack < -resolution && late.duration_s - early_s > resolution_s) {
        const double share = early_weight / (early_weight - late_weight);
        const Step step = step_of(early_s + share * (late.duration_s - early_s));
        const double value = slack_of(step);
        const bool is_late = value <= 0.0;
        if (is_late) {
            if (was_late == true) early_weight *= 0.5;
            late = step;
            late_slack = late_weight = value;
        } else {
            if (was_late == false) late_weight *= 0.5;
            early_s = step.duration_s;
            early_weight = value;
        }
        was_late = is_late;
    }
    return late;
}

}  // namespace fidservo::plant
