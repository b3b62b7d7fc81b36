// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/report/traces.h"

#include "core/time.h"
#include "src/diagnose/report/trace_course.h"
#include "src/diagnose/words.h"
#include "src/report/html.h"
#include "src/report/plot.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

using gap::Signal;

constexpr std::size_t most_points = 4000;  ///< of each guide, beside those of the worst windows

/// Recorded values plus errors, in the unit of the values.
std::vector<float> sum_of(const std::vector<float>& recorded, const std::vector<float>& error, float unit) {
    std::vector<float> sum(recorded.size());
    std::ranges::transform(recorded, error, sum.begin(),
                           [&](float value, float difference) { return value + unit * difference; });
    return sum;
}

/// Rows to draw: the envelopes of all traces, and every row of the marked stretches.
std::vector<std::size_t> drawn_rows(const TraceCourse& course, const std::vector<report::Span>& marked) {
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
        if (std::ranges::any_of(marked, [&](const report::Span& span) {
                return course.time_s[k] >= span.from_s && course.time_s[k] <= span.to_s;
            }))
            rows.push_back(k);
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

std::vector<report::TimePlot> plots_of(const TraceCourse& course, const std::vector<std::size_t>& rows,
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
    if (signal == Signal::image) {
        add("edges", "Error of the edges' blur, mean of a tag's sides", "floors", error_height_px,
            both(before, after, 2));
        add("light", "Error of light and noise, r.m.s. of a tag", "floors", error_height_px,
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
    add("errors", "Error: predicted minus recorded", display.unit, error_height_px,
        both(before, after, display.unit == "mm" ? 3 : 2));
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

/// The seconds in which the rig file alone and the explanation do worst.
std::vector<report::Span> worst_spans(const gap::Evidence& evidence, const Predictions& predictions,
                                      std::size_t run, Signal signal) {
    const Recording& recording = evidence.recordings()[run];
    std::vector<report::Span> spans;
    const auto add = [&](const gap::Window& window, const gap::Errors& errors, const char* label) {
        RootMeanSquare size;
        size.add(errors, window);
        const double from_s = seconds(window.start_ns - recording.rows.front().time_ns);
        spans.push_back({from_s, from_s + static_cast<double>(window.rows) * recording.tick_s, label,
                         size_class(size.value()) > 0 ? "bad" : "neutral"});
    };
    const gap::Window* before = worst_window(evidence, predictions.nominal, run, signal);
    const gap::Window* after = worst_window(evidence, predictions.explained, run, signal);
    add(*before, predictions.nominal, after == before ? "worst" : "worst before");
    if (after != nullptr && after != before) add(*after, predictions.explained, "worst after");
    return spans;
}

std::string signal_html(const gap::Evidence& evidence, const Predictions& predictions, std::size_t run,
                        Signal signal, const RunGap& size) {
    const Recording& recording = evidence.recordings()[run];
    const DisplayUnit display = display_unit(evidence.rig(), signal, size.before * evidence.floor(signal));
    const TraceCourse course = signal == Signal::tag ? course_of_frames(evidence, predictions, run)
                               : signal == Signal::image
                                   ? course_of_looks(evidence, predictions, run)
                                   : course_of_rows(evidence, predictions, run, signal, display);
    report::TimeAxis axis{{}, worst_spans(evidence, predictions, run, signal)};
    const std::vector<std::size_t> rows = drawn_rows(course, axis.spans);
    for (const std::size_t row : rows) axis.time_s.push_back(course.time_s[row]);
    const std::string after =
        !predictions.is_explained ? ""
        : are_equal(course.nominal_error, course.explained_error)
            ? "; the explanation changes nothing here"
            : fmt::format(", {} with the explanation", report::escaped(floors_words(size.after)));
    std::string html = fmt::format(
        "<h3>{} \u2013 {}</h3>\n<p class=\"remark\">{} floors r.m.s. in this recording with the rig file as "
        "it is{}.</p>\n",
        report::escaped(capitalised(std::string(signal_words(signal)))), report::escaped(recording.name),
        report::escaped(floors_words(size.before)), after);
    html += report::time_plots(axis, plots_of(course, rows, signal, display));
    if (rows.size() < course.time_s.size())
        html += fmt::format(
            "<p class=\"remark\">{} of {} samples are drawn: all in the marked stretches, elsewhere the "
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
           "where the simulator is wrong.</p>\n" +
           html + agreeing;
}

}  // namespace fidservo::diagnose
