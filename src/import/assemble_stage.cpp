// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/assemble_stage.h"

#include "core/input_error.h"
#include "src/import/interrupted.h"
#include "src/import/resample.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>

#include <fmt/format.h>

namespace fidservo::imports {
namespace {

constexpr std::uint64_t most_rows = std::uint64_t{1} << 26U;

/// A column of the stage, from its signal.
struct ColumnSignal {
    std::size_t column;  ///< of stage_columns
    std::string name;
    TimedSignal signal;
    bool is_held;
    bool is_command;          ///< command or setpoint: one without a number is not in force
    std::size_t missing = 0;  ///< samples of a reading without a number
    TimeNs interval_ns = 0;   ///< median_interval() of its times
};

std::vector<ColumnSignal> column_signals(SignalSource& source, const ImportMap& map, Assembled& made) {
    std::vector<ColumnSignal> all;
    for (std::size_t k = 0; k < stage_columns.size(); ++k) {
        const std::string name(name_of_title(stage_columns[k].title));
        const auto choice = map.columns.find(name);
        if (choice == map.columns.end()) continue;
        const bool is_command = name.ends_with("_command") || name.ends_with("_setpoint");
        TimedSignal signal = source.timed(choice->second, unit_of_title(stage_columns[k].title));
        const bool is_as_logged =
            signal.values.size() == signal.signal->values.size() &&
            std::ranges::equal(signal.values, signal.signal->values,
                               [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); });
        if (is_as_logged) made.decimals[k] = choice->second.decimals.value_or(signal.signal->decimals);
        const std::ptrdiff_t missing =
            is_command ? 0 : std::ranges::count_if(signal.values, [](double v) { return std::isnan(v); });
        if (missing == std::ssize(signal.values))
            throw InputError(
                fmt::format("{}: {}: holds no number", signal.log->file.string(), signal.signal->name));
        all.push_back({k, name, std::move(signal), choice->second.is_held.value_or(is_command), is_command,
                       static_cast<std::size_t>(missing)});
        all.back().interval_ns = median_interval(all.back().signal.time_ns);
        made.recording.columns.*stage_columns[k].present = true;
    }
    return all;
}

bool have_same_times(const std::vector<ColumnSignal>& columns) {
    return std::ranges::all_of(columns, [&](const ColumnSignal& column) {
        return column.signal.time_ns == columns.front().signal.time_ns;
    });
}

ColumnSignal without_missing(ColumnSignal column) {
    TimedSignal& signal = column.signal;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < signal.values.size(); ++k) {
        if (std::isnan(signal.values[k])) continue;
        signal.values[kept] = signal.values[k];
        signal.time_ns[kept++] = signal.time_ns[k];
    }
    signal.values.resize(kept);
    signal.time_ns.resize(kept);
    column.interval_ns = median_interval(signal.time_ns);
    return column;
}

std::string source_text(const ColumnSignal& column) {
    const std::string rate = column.interval_ns == 0
                                 ? std::string("one sample")
                                 : fmt::format("{} samples at {:.6g} Hz", column.signal.time_ns.size(),
                                               1e9 / static_cast<double>(column.interval_ns));
    return fmt::format("{}: {} of {}, {}{}", column.name, column.signal.signal->name,
                       column.signal.log->file.string(), rate,
                       column.missing > 0 ? fmt::format(" ({} more have no number)", column.missing) : "");
}

/// All columns of the stage, and the samples of each that have a number.
class Columns {
  public:
    explicit Columns(std::vector<ColumnSignal> logged) : logged_(std::move(logged)) {
        for (const ColumnSignal& column : logged_)
            present_.push_back(column.missing == 0 ? &column
                                                   : &reduced_.emplace_back(without_missing(column)));
    }
    Columns(const Columns&) = delete;
    Columns& operator=(const Columns&) = delete;

    /// The shortest interval of a signal at a steady rate; if there is none, of any.
    std::optional<TimeNs> tick_ns() const {
        std::optional<TimeNs> steady, any;
        for (const ColumnSignal* column : present_) {
            const TimeNs interval = column->interval_ns;
            if (interval == 0) continue;
            any = std::min(any.value_or(interval), interval);
            if (is_steady(column->signal.time_ns, interval))
                steady = std::min(steady.value_or(interval), interval);
        }
        return steady ? steady : any;
    }

    bool are_rows_of(double tick_s) const {
        const TimeNs tick = nanoseconds(tick_s);
        return have_same_times(logged_) && std::ranges::all_of(present_, [&](const ColumnSignal* column) {
                   return column->interval_ns == 0 ||
                          (2 * column->interval_ns < 3 * tick && is_steady(column->signal.time_ns, tick));
               });
    }

    void take_rows(Assembled& made) const;
    void make_rows(Assembled& made) const;

  private:
    struct Span {
        TimeNs first, last;
    };
    Span common_span() const;
    void say_resampled(const ColumnSignal& column, double tick_s, const Span& span, Assembled& made) const;

    std::vector<ColumnSignal> logged_;
    std::deque<ColumnSignal> reduced_;          ///< those of the columns that lack some
    std::vector<const ColumnSignal*> present_;  ///< of the two above
};

void Columns::take_rows(Assembled& made) const {
    const std::vector<TimeNs>& times = logged_.front().signal.time_ns;
    std::size_t left_out = 0;
    for (std::size_t k = 0; k < times.size(); ++k) {
        StageRow row;
        row.time_ns = times[k];
        bool is_whole = true;
        for (const ColumnSignal& column : logged_) {
            row.*stage_columns[column.column].value = column.signal.values[k];
            is_whole = is_whole && (column.is_command || !std::isnan(column.signal.values[k]));
        }
        if (is_whole)
            made.recording.rows.push_back(row);
        else
            ++left_out;
    }
    for (const ColumnSignal* column : present_) made.notes.push_back(source_text(*column) + ", as they are");
    if (left_out > 0)
        made.notes.push_back(
            fmt::format("{} of {} rows left out: a reading has no number in them", left_out, times.size()));
}

void Columns::say_resampled(const ColumnSignal& column, double tick_s, const Span& span,
                            Assembled& made) const {
    const std::vector<TimeNs>& times = column.signal.time_ns;
    const double ratio = tick_s / std::max(1e-9, seconds(column.interval_ns));
    const double lost_s =
        std::max(0.0, seconds(span.first - times.front())) + std::max(0.0, seconds(times.back() - span.last));
    made.notes.push_back(fmt::format(
        "{}, resampled to {:.6g} Hz: {}{}{}", source_text(column), 1.0 / tick_s,
        column.is_held ? "held from sample to sample" : "on lines between samples",
        !column.is_held && ratio > gap_in_intervals
            ? fmt::format("; {:.3g} samples a row, faster motion is not filtered out", ratio)
            : "",
        !column.is_command && lost_s > tick_s
            ? fmt::format("; {:.3g} s of it left out, in which another signal has no samples", lost_s)
            : ""));
}

/// The last time at which a column has a value: that of its last sample; where values are held, as long after
/// it as after the others, and without end where they are logged only when they change.
TimeNs end_of(const ColumnSignal& column) {
    constexpr std::size_t fewest_steady = 20;
    const std::vector<TimeNs>& times = column.signal.time_ns;
    if (!column.is_held) return times.back();
    if (times.size() < fewest_steady || !is_steady(times, column.interval_ns))
        return std::numeric_limits<TimeNs>::max();
    constexpr TimeNs parts = 1000;
    return times.back() + column.interval_ns -
           column.interval_ns / parts;  // not at the time of a next sample
}

Columns::Span Columns::common_span() const {
    const auto by_first = [](const ColumnSignal* column) { return column->signal.time_ns.front(); };
    const auto by_last = [](const ColumnSignal* column) { return column->signal.time_ns.back(); };
    std::vector<TimeNs> ends;
    for (const ColumnSignal* column : present_) ends.push_back(end_of(*column));
    const auto first_end = std::ranges::min_element(ends);
    const ColumnSignal& begins = **std::ranges::max_element(present_, {}, by_first);
    const ColumnSignal& stops = *present_[static_cast<std::size_t>(first_end - ends.begin())];
    const TimeNs end_of_log = by_last(*std::ranges::max_element(present_, {}, by_last));
    const Span span{by_first(&begins), std::min(*first_end, end_of_log)};
    if (span.last <= span.first)
        throw InputError(fmt::format(
            "{}: the signals share no time: {} begins {:.6g} s after {} has ended; a clock needs "
            "offset_s or fit",
            begins.signal.log->file.string(), begins.name, seconds(span.first - span.last), stops.name));
    return span;
}

void Columns::make_rows(Assembled& made) const {
    const Span span = common_span();
    const double tick_s = made.recording.tick_s;
    const double count = std::floor(seconds(span.last - span.first) / tick_s + 1e-6) + 1.0;
    if (count > static_cast<double>(most_rows))
        throw InputError(fmt::format("{}: {:.0f} rows of {} s: at most {} are made",
                                     logged_.front().signal.log->file.string(), count, tick_s, most_rows));
    std::vector<Resampler> resamplers;
    for (const ColumnSignal* column : present_) {
        resamplers.emplace_back(column->signal.time_ns, column->signal.values,
                                column->is_held ? Between::hold : Between::line);
        made.decimals[column->column] = -1;
        say_resampled(*column, tick_s, span, made);
    }
    std::size_t left_out = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
        StageRow row;
        end_if_interrupted();
        row.time_ns = std::min(span.last, span.first + nanoseconds(static_cast<double>(k) * tick_s));
        bool is_in_gap = false;
        for (std::size_t c = 0; c < present_.size(); ++c) {
            const RowValue value = resamplers[c].at(row.time_ns);
            row.*stage_columns[present_[c]->column].value = value.value;
            is_in_gap = is_in_gap || value.is_in_gap;
        }
        if (is_in_gap)
            ++left_out;
        else
            made.recording.rows.push_back(row);
    }
    if (left_out > 0)
        made.notes.push_back(
            fmt::format("{} of {:.0f} rows left out: a reading has no sample near them", left_out, count));
}

void demand_measured(const Recording& recording, const ImportMap& map) {
    const StageColumns& has = recording.columns;
    if (!has.encoder && !has.position && !has.hall)
        throw InputError(fmt::format(
            "{}: columns: encoder, position or hall is missing: nothing was measured", map.file.string()));
}

}  // namespace

void add_stage(SignalSource& source, const ImportMap& map, Assembled& made) {
    std::vector<ColumnSignal> logged = column_signals(source, map, made);
    if (logged.empty()) return;
    demand_measured(made.recording, map);
    const Columns columns(std::move(logged));
    double& tick_s = made.recording.tick_s;
    if (tick_s == 0.0) {
        const std::optional<TimeNs> interval = columns.tick_ns();
        if (!interval)
            throw InputError(
                fmt::format("{}: recording.tick_s: missing, and one sample has no rate", map.file.string()));
        tick_s = nearby_tick_s(*interval);
        made.notes.push_back(fmt::format("tick_s: {}, from the times of the columns", tick_s));
    }
    if (tick_s > 1.0)
        throw InputError(
            fmt::format("{}: a tick of {} s: at most 1 s is allowed", map.file.string(), tick_s));
    if (columns.are_rows_of(tick_s))
        columns.take_rows(made);
    else
        columns.make_rows(made);
}

}  // namespace fidservo::imports
