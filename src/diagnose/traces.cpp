#include "src/diagnose/traces.h"

#include "core/time.h"
#include "src/diagnose/words.h"
#include "src/report/html.h"
#include "src/report/plot.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

using gap::Signal;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t most_points = 1500;  ///< of each guide, beside those of the worst window

/// A signal along a recording, errors in the unit that people read. Of tags there is no recorded trace.
struct Course {
    std::vector<double> time_s;
    std::vector<float> recorded, nominal_error, explained_error;
    std::vector<float> nominal_across, explained_across;  ///< of tags, in floors
};

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
            break;
    }
    return not_in_force;
}

/// In which unit values are drawn: errors of um are those of mm.
struct ValueUnit {
    std::string_view unit;
    float per_error_unit;
    int digits;
};

ValueUnit value_unit(Signal signal, const DisplayUnit& errors) {
    constexpr float thousandth = 1e-3f;
    if (signal == Signal::encoder) return {"mm", errors.unit == "mm" ? 1.0f : thousandth, 3};
    if (signal == Signal::hall) return {errors.unit, 1.0f, 1};
    return {"V", thousandth, 4};
}

Course course_of_rows(const gap::Evidence& evidence, const Predictions& predictions, std::size_t run,
                      Signal signal, const DisplayUnit& display) {
    const Recording& recording = evidence.recordings()[run];
    const double unit = display.per_own_unit,
                 value = unit * static_cast<double>(value_unit(signal, display).per_error_unit);
    Course course;
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

/// Mean along the motion and r.m.s. across it, of a frame's detections from index `first` up to `end`.
void add_frame(Course& course, const gap::Window& window, const Predictions& predictions, std::size_t first,
               std::size_t end) {
    constexpr std::size_t values = 8;
    const auto of = [&](const gap::Errors& errors, std::vector<float>& along, std::vector<float>& across) {
        double sum = 0.0, squares = 0.0, known = 0.0;
        for (std::size_t i = first; i < end; ++i) {
            const std::size_t at = window.begin + values * i;
            if (std::isnan(errors[at])) continue;
            sum += static_cast<double>(errors[at]);
            for (std::size_t k = 1; k < values; ++k)
                squares += static_cast<double>(errors[at + k]) * static_cast<double>(errors[at + k]);
            known += 1.0;
        }
        along.push_back(known > 0.0 ? static_cast<float>(sum / known) : nan);
        across.push_back(known > 0.0 ? static_cast<float>(std::sqrt(squares / (known * (values - 1)))) : nan);
    };
    of(predictions.nominal, course.nominal_error, course.nominal_across);
    of(predictions.explained, course.explained_error, course.explained_across);
}

Course course_of_frames(const gap::Evidence& evidence, const Predictions& predictions, std::size_t run) {
    const Recording& recording = evidence.recordings()[run];
    Course course;
    for (const gap::Window& window : evidence.windows()) {
        if (window.run != run || window.signal != Signal::tag) continue;
        const std::size_t detections = (window.end - window.begin) / 8;
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

/// Recorded values plus errors, in the unit of the values.
std::vector<float> sum_of(const std::vector<float>& recorded, const std::vector<float>& error, float unit) {
    std::vector<float> sum(recorded.size());
    std::ranges::transform(recorded, error, sum.begin(),
                           [&](float value, float difference) { return value + unit * difference; });
    return sum;
}

/// Rows to draw: the envelopes of all traces, and every row of the worst window.
std::vector<std::size_t> drawn_rows(const Course& course, double from_s, double to_s) {
    std::vector<std::size_t> rows;
    const auto add = [&](const std::vector<float>& guide) {
        if (guide.empty()) return;
        std::vector<float> known = guide;
        std::ranges::replace_if(
            known, [](float value) { return std::isnan(value); }, 0.0f);
        const auto found = report::envelope_rows(known, most_points);
        rows.insert(rows.end(), found.begin(), found.end());
    };
    add(course.recorded);
    add(course.nominal_error);
    add(course.explained_error);
    for (std::size_t k = 0; k < course.time_s.size(); ++k)
        if (course.time_s[k] >= from_s && course.time_s[k] <= to_s) rows.push_back(k);
    std::ranges::sort(rows);
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    return rows;
}

std::vector<float> picked(const std::vector<float>& values, const std::vector<std::size_t>& rows) {
    std::vector<float> kept(rows.size());
    std::ranges::transform(rows, kept.begin(), [&](std::size_t row) { return values[row]; });
    return kept;
}

bool are_equal(const std::vector<float>& a, const std::vector<float>& b) {
    return std::ranges::equal(a, b, [](float left, float right) {
        return left == right || (std::isnan(left) && std::isnan(right));
    });
}

/// The traces of before and after; of before alone where the explanation changes nothing.
std::vector<report::Trace> both(const std::vector<float>& before, const std::vector<float>& after,
                                int digits) {
    std::vector<report::Trace> traces{{"rig file as it is", before, false, digits, false}};
    if (!are_equal(before, after)) traces.push_back({"with the explanation", after, false, digits, false});
    return traces;
}

std::vector<report::TimePlot> plots_of(const Course& course, const std::vector<std::size_t>& rows,
                                       Signal signal, const DisplayUnit& display) {
    const std::string id = fmt::format("traces-{}", gap::name_of(signal));
    constexpr int value_height_px = 260, error_height_px = 220;
    std::vector<report::TimePlot> plots;
    const auto add = [&](std::string_view part, const std::string& title, std::string_view unit,
                         int height_px, std::vector<report::Trace> traces) {
        plots.push_back(
            {fmt::format("{}-{}", id, part), title, std::string(unit), id, height_px, std::move(traces)});
    };
    const std::vector<float> before = picked(course.nominal_error, rows),
                             after = picked(course.explained_error, rows);
    if (signal == Signal::tag) {
        add("along", "Error along the motion, mean of a frame's tags", "floors", error_height_px,
            both(before, after, 2));
        add("across", "Error across the motion, r.m.s. of a frame's corners", "floors", error_height_px,
            both(picked(course.nominal_across, rows), picked(course.explained_across, rows), 2));
        return plots;
    }
    const std::vector<float> recorded = picked(course.recorded, rows);
    const ValueUnit drawn = value_unit(signal, display);
    std::vector<report::Trace> values = both(sum_of(recorded, before, drawn.per_error_unit),
                                             sum_of(recorded, after, drawn.per_error_unit), drawn.digits);
    values.insert(values.begin(), report::Trace{"recorded", recorded, false, drawn.digits, true});
    const std::string name = capitalised(std::string(signal_words(signal)));
    add("values", name, drawn.unit, value_height_px, std::move(values));
    add("errors", "Error: predicted minus recorded", display.unit, error_height_px, both(before, after, 2));
    return plots;
}

/// A signal's recording in which the rig file alone does worst.
struct WorstRun {
    Signal signal;
    std::size_t run;
    RunGap size;
};

/// Of all signals that were judged, the largest gap first.
std::vector<WorstRun> worst_runs(const std::vector<RunGaps>& gaps) {
    std::vector<WorstRun> worst;
    for (std::size_t s = 0; s < gap::signal_count; ++s) {
        std::optional<WorstRun> of_signal;
        for (std::size_t run = 0; run < gaps.size(); ++run) {
            const RunGap& size = gaps[run][s];
            if (!std::isnan(size.before) && (!of_signal || size.before > of_signal->size.before))
                of_signal = {static_cast<Signal>(s), run, size};
        }
        if (of_signal) worst.push_back(*of_signal);
    }
    std::ranges::stable_sort(worst, std::greater{}, [](const WorstRun& one) { return one.size.before; });
    return worst;
}

std::string signal_html(const gap::Evidence& evidence, const Predictions& predictions, std::size_t run,
                        Signal signal, const RunGap& size) {
    const Recording& recording = evidence.recordings()[run];
    const gap::Window* worst = worst_window(evidence, predictions.nominal, run, signal);
    const double from_s = seconds(worst->start_ns - recording.rows.front().time_ns),
                 to_s = from_s + static_cast<double>(worst->rows) * recording.tick_s;
    const DisplayUnit display = display_unit(evidence.rig(), signal, size.before * evidence.floor(signal));
    const Course course = signal == Signal::tag ? course_of_frames(evidence, predictions, run)
                                                : course_of_rows(evidence, predictions, run, signal, display);
    const std::vector<std::size_t> rows = drawn_rows(course, from_s, to_s);
    report::TimeAxis axis;
    for (const std::size_t row : rows) axis.time_s.push_back(course.time_s[row]);
    axis.spans.push_back({from_s, to_s, "worst second", size_class(size.before) > 0 ? "bad" : "neutral"});
    const std::string after =
        !predictions.is_explained ? ""
        : are_equal(course.nominal_error, course.explained_error)
            ? "; the explanation changes nothing here"
            : fmt::format(", {} with the explanation", report::escaped(floors_words(size.after)));
    std::string html = fmt::format(
        "<h3>{} \u2013 {}</h3>\n<p class=\"remark\">{} floors r.m.s. in this recording with the rig file as "
        "it "
        "is{}.</p>\n",
        report::escaped(capitalised(std::string(signal_words(signal)))), report::escaped(recording.name),
        report::escaped(floors_words(size.before)), after);
    html += report::time_plots(axis, plots_of(course, rows, signal, display));
    if (rows.size() < course.time_s.size())
        html += fmt::format(
            "<p class=\"remark\">{} of {} samples are drawn: all of the marked second, and elsewhere the "
            "extremes.</p>\n",
            rows.size(), course.time_s.size());
    return html;
}

}  // namespace

std::string traces_html(const gap::Evidence& evidence, const Predictions& predictions) {
    std::string html, agreeing;
    for (const auto& [signal, run, size] : worst_runs(gaps_by_run(evidence, predictions))) {
        const bool is_command = signal == Signal::macro_command || signal == Signal::micro_command;
        if (is_command && size_class(size.before) == 0)
            agreeing += fmt::format(
                "<p>The {} follows from the rig file's controller to {} floors at worst; it is not "
                "drawn.</p>\n",
                signal_words(signal), report::escaped(floors_words(size.before)));
        else
            html += signal_html(evidence, predictions, run, signal, size);
    }
    return "<p class=\"remark\">Predictions begin anew every second, from the recording: hence the steps "
           "where "
           "the simulator is wrong.</p>\n" +
           html + agreeing;
}

}  // namespace fidservo::diagnose
