// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/report/trace_course.h"

#include "core/rig.h"
#include "core/time.h"

#include <cmath>
#include <limits>

namespace fidservo::diagnose {
namespace {

using gap::Signal;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

double recorded_value(const StageRow& row, Signal signal, const MacroParameters& macro) {
    switch (signal) {
        case Signal::encoder:
            return std::isfinite(row.encoder_count) ? row.encoder_count
                                                    : row.position_mm / macro.encoder_resolution_mm;
        case Signal::hall:
            return row.hall_adc;
        case Signal::macro_command:
            return row.macro_command_V;
        case Signal::micro_command:
            return row.micro_command_V;
        case Signal::tag:
        case Signal::image:
            break;
    }
    return not_in_force;
}

/// Mean along the motion and r.m.s. across it, of a frame's detections from index `first` up to `end`.
void add_frame(TraceCourse& course, const gap::Window& window, const Predictions& predictions,
               std::size_t first, std::size_t end) {
    const auto of = [&](const gap::Errors& errors, std::vector<float>& along, std::vector<float>& across) {
        double sum = 0.0, squares = 0.0, known = 0.0;
        for (std::size_t i = first; i < end; ++i) {
            const std::size_t at = window.begin + gap::corner_values * i;
            if (std::isnan(errors[at])) continue;
            sum += static_cast<double>(errors[at]);
            for (std::size_t k = 1; k < gap::corner_values; ++k)
                squares += static_cast<double>(errors[at + k]) * static_cast<double>(errors[at + k]);
            known += 1.0;
        }
        along.push_back(known > 0.0 ? static_cast<float>(sum / known) : nan);
        across.push_back(
            known > 0.0 ? static_cast<float>(std::sqrt(squares / (known * (gap::corner_values - 1)))) : nan);
    };
    of(predictions.nominal, course.nominal_error, course.nominal_across);
    of(predictions.explained, course.explained_error, course.explained_across);
}

/// Mean of an appearance's edges, and r.m.s. of its light and noise.
void add_looks(TraceCourse& course, const Predictions& predictions, std::size_t begin) {
    constexpr std::size_t edges = 4;
    const auto of = [&](const gap::Errors& errors, std::vector<float>& of_edges,
                        std::vector<float>& of_rest) {
        double sum = 0.0, squares = 0.0, sides = 0.0, others = 0.0;
        for (std::size_t k = 0; k < gap::image_values; ++k) {
            const double error = errors[begin + k];
            if (std::isnan(error)) continue;
            (k < edges ? sum : squares) += k < edges ? error : error * error;
            (k < edges ? sides : others) += 1.0;
        }
        of_edges.push_back(sides > 0.0 ? static_cast<float>(sum / sides) : nan);
        of_rest.push_back(others > 0.0 ? static_cast<float>(std::sqrt(squares / others)) : nan);
    };
    of(predictions.nominal, course.nominal_error, course.nominal_across);
    of(predictions.explained, course.explained_error, course.explained_across);
}

}  // namespace

ValueUnit value_unit(Signal signal, const DisplayUnit& errors) {
    constexpr float thousandth = 1e-3f;
    if (signal == Signal::encoder) return {"mm", errors.unit == "mm" ? 1.0f : thousandth, 3};
    if (signal == Signal::hall) return {errors.unit, 1.0f, 1};
    return {"V", thousandth, 4};
}

TraceCourse course_of_rows(const gap::Evidence& evidence, const Predictions& predictions, std::size_t run,
                           Signal signal, const DisplayUnit& display) {
    const Recording& recording = evidence.recordings()[run];
    const double unit = display.per_own_unit,
                 value = unit * static_cast<double>(value_unit(signal, display).per_error_unit);
    TraceCourse course;
    for (const StageRow& row : recording.rows) {
        course.time_s.push_back(seconds(row.time_ns - recording.rows.front().time_ns));
        course.recorded.push_back(
            static_cast<float>(recorded_value(row, signal, evidence.rig().macro) * value));
    }
    course.nominal_error.assign(course.time_s.size(), nan);
    course.explained_error = course.nominal_error;
    const auto scale = static_cast<float>(evidence.floor(signal) * unit);
    for (const gap::Window& window : evidence.windows()) {
        if (window.run != run || window.signal != signal) continue;
        for (std::size_t k = 0; k < window.rows; ++k) {
            course.nominal_error[window.first_row + k] = scale * predictions.nominal[window.begin + k];
            course.explained_error[window.first_row + k] = scale * predictions.explained[window.begin + k];
        }
    }
    return course;
}

TraceCourse course_of_frames(const gap::Evidence& evidence, const Predictions& predictions, std::size_t run) {
    const Recording& recording = evidence.recordings()[run];
    TraceCourse course;
    for (const gap::Window& window : evidence.windows()) {
        if (window.run != run || window.signal != Signal::tag) continue;
        const std::size_t detections = (window.end - window.begin) / gap::corner_values;
        const auto time_ns = [&](std::size_t i) {
            return recording.detections[window.first_detection + i].time_ns;
        };
        for (std::size_t first = 0; first < detections;) {
            std::size_t end = first + 1;
            while (end < detections && time_ns(end) == time_ns(first)) ++end;
            course.time_s.push_back(seconds(time_ns(first) - recording.rows.front().time_ns));
            add_frame(course, window, predictions, first, end);
            first = end;
        }
    }
    return course;
}

TraceCourse course_of_looks(const gap::Evidence& evidence, const Predictions& predictions, std::size_t run) {
    const Recording& recording = evidence.recordings()[run];
    TraceCourse course;
    for (const gap::Window& window : evidence.windows()) {
        if (window.run != run || window.signal != Signal::image) continue;
        for (std::size_t i = 0; window.begin + gap::image_values * i < window.end; ++i) {
            const TagAppearance& seen = recording.appearances[window.first_detection + i];
            course.time_s.push_back(seconds(seen.time_ns - recording.rows.front().time_ns));
            add_looks(course, predictions, window.begin + gap::image_values * i);
        }
    }
    return course;
}

}  // namespace fidservo::diagnose
