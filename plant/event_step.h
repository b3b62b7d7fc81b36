// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Integration steps that end at an event.
#include <optional>

namespace fidservo::plant {

/// The shortest step, s.
inline constexpr double shortest_step_s = 1e-10;

/// A step that ends just past an event, found by regula falsi (Illinois variant) on the slack, the distance
/// to the event.
/// @param slack_at_start  the slack where the step begins; if it is 0 or negative, the motion first leaves
///                        this event and then meets the next one within the step
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
