// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/recording/last_digit.h"
#include "src/files/recording/reader.h"
#include "src/files/recording/row_format.h"
#include "src/import/recording_folder.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <iterator>
#include <string_view>

#include <fmt/compile.h>
#include <fmt/format.h>

namespace fidservo::imports {
namespace {

constexpr int most_exact_decimals = 12;
constexpr int shortest_of_each = -1;

bool is_given_back(double value, int decimals) {
    fmt::memory_buffer text;
    fmt::format_to(std::back_inserter(text), FMT_COMPILE("{:.{}f}"), value, decimals);
    double read = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), read);
    return read == value;
}

/// By calls of all_at(decimals): whether every number is given back.
int exact_decimals(int first, const std::function<bool(int)>& all_at) {
    for (int decimals = first; decimals <= most_exact_decimals; ++decimals)
        if (all_at(decimals)) return decimals;
    return shortest_of_each;
}

void append_exact(std::string& text, double value, int decimals) {
    text += ',';
    if (std::isnan(value)) return;
    if (value == 0.0) value = 0.0;  // zero has no sign
    if (decimals == shortest_of_each)
        fmt::format_to(std::back_inserter(text), FMT_COMPILE("{}"), value);
    else
        fmt::format_to(std::back_inserter(text), FMT_COMPILE("{:.{}f}"), value, decimals);
}

/// The decimals with which a column is written: those that its log has, where they give every number back.
int decimals_of_column(const Recording& recording, const StageColumn& column, int logged) {
    const auto all_at = [&](int count) {
        return std::ranges::all_of(recording.rows, [&](const StageRow& row) {
            return std::isnan(row.*column.value) || is_given_back(row.*column.value, count);
        });
    };
    return logged >= 0 && all_at(logged) ? logged : exact_decimals(column.decimals, all_at);
}

}  // namespace

std::string stage_text(const Recording& recording, const ColumnDecimals& logged) {
    ColumnDecimals decimals{};
    for (std::size_t k = 0; k < stage_columns.size(); ++k)
        if (recording.columns.*stage_columns[k].present)
            decimals[k] = decimals_of_column(recording, stage_columns[k], logged[k]);
    std::string text = stage_header(recording.columns);
    for (const StageRow& row : recording.rows) {
        fmt::format_to(std::back_inserter(text), FMT_COMPILE("{}"), row.time_ns);
        for (std::size_t k = 0; k < stage_columns.size(); ++k)
            if (recording.columns.*stage_columns[k].present)
                append_exact(text, row.*stage_columns[k].value, decimals[k]);
        text += '\n';
    }
    return text;
}

std::string detections_text(const std::vector<TagDetection>& detections) {
    const bool has_more = std::ranges::any_of(detections, [](const TagDetection& tag) {
        return tag.is_refined.has_value() || tag.covariances_px2.has_value();
    });
    const int decimals = exact_decimals(corner_decimals, [&](int count) {
        return std::ranges::all_of(detections, [&](const TagDetection& tag) {
            return std::ranges::all_of(tag.corners_px, [&](const Eigen::Vector2d& corner) {
                return is_given_back(corner.x(), count) && is_given_back(corner.y(), count);
            });
        });
    });
    std::string text =
        detections_header(has_more ? CornerColumns::places_and_covariances : CornerColumns::places);
    for (const TagDetection& tag : detections) {
        fmt::format_to(std::back_inserter(text), FMT_COMPILE("{},{}"), tag.time_ns, tag.tag_id);
        for (const Eigen::Vector2d& corner : tag.corners_px)
            for (const double place : {corner.x(), corner.y()}) append_exact(text, place, decimals);
        if (has_more) text += tag.is_refined ? (*tag.is_refined ? ",1" : ",0") : ",";
        if (has_more && tag.covariances_px2)
            for (const Eigen::Matrix2d& corner : *tag.covariances_px2)
                for (const double term : {corner(0, 0), corner(0, 1), corner(1, 1)})
                    append_exact(text, term, shortest_of_each);
        else if (has_more)
            text.append(covariance_titles.size(), ',');
        text += '\n';
    }
    return text;
}

void make_as_read(Recording& recording, const ColumnDecimals& logged) {
    give_print_of_plate(recording);
    const StageColumn& column = stage_columns.front();
    const int decimals = decimals_of_column(recording, column, logged.front());
    LastDigit setpoint;
    std::string text;
    for (const StageRow& row : recording.rows) {
        if (std::isnan(row.macro_setpoint_mm)) continue;
        text.clear();
        append_exact(text, row.macro_setpoint_mm, decimals);
        setpoint.saw(std::string_view(text).substr(1));
    }
    recording.macro_setpoint_step_mm = setpoint.step().value_or(RecordingHeader().macro_setpoint_step_mm);
}

int setpoint_decimals(const Recording& recording) {
    return static_cast<int>(std::lround(-std::log10(recording.macro_setpoint_step_mm)));
}

ColumnDecimals decimals_without_log(const Recording& recording) {
    ColumnDecimals decimals{};
    decimals.fill(-1);
    decimals.front() = setpoint_decimals(recording);
    return decimals;
}

}  // namespace fidservo::imports
