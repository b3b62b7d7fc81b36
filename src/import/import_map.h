// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The map that assigns a log's signals to a recording's columns: format fidservo-map/1 (docs/import.md).
#include "core/recording.h"
#include "src/files/recording/description.h"
#include "src/files/table/table_structure.h"
#include "src/files/text/yaml_reader.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo::imports {

inline constexpr std::string_view map_format = "fidservo-map/1";

/// A signal of the log with its conversion.
struct SignalChoice {
    std::string signal;
    std::string unit;     ///< of the signal; empty: the unit that the log file states
    double factor = 1.0;  ///< recording's units per unit of the signal, applied after any conversion
    bool has_factor = false;
    double offset = 0.0;             ///< in the recording's unit, added after the factor
    std::string clock;               ///< empty: the signal's own times, or the map's first clock
    std::optional<bool> is_held;     ///< values between samples: the last one, or linear interpolation
    std::optional<int> decimals;     ///< number of decimals to which the log's numbers are rounded
    std::optional<YamlValue> where;  ///< place in the map, for messages
};

/// Two signals of the same motion; the first one is on the clock to be fitted.
struct ClockFitChoice {
    std::string signal, to;
};

/// A clock: recording's time = offset + (1 + rate 1e-6) clock's time, s.
struct ClockChoice {
    std::string name;
    SignalChoice times;  ///< empty: the clock has rate_hz, or each signal its own times
    std::optional<double> rate_hz;
    double offset_s = 0.0;
    double rate_ppm = 0.0;
    std::optional<ClockFitChoice> fit;
    std::optional<YamlValue> where;
};

struct CameraChoice {
    std::string images, info, clock;
    double offset_s = 0.0;  ///< from the log's time to the middle of the exposure
    std::optional<YamlValue> where;
};

struct ImportMap {
    std::filesystem::path file;
    Recording stated;  ///< what the map states under `recording`; tick_s 0: not stated
    RecordingOrigin origin;
    TableOptions table;
    std::vector<ClockChoice> clocks;                 ///< the first one is the recording's
    std::map<std::string, SignalChoice> columns;     ///< by the column's name without its unit
    std::map<std::string, SignalChoice> detections;  ///< tag_id, p0_x, ..
    std::string detections_clock;
    std::optional<CameraChoice> camera;
    std::filesystem::path plate;  ///< empty: none

    const ClockChoice* clock(std::string_view name) const;
};

/// Reads a map. Throws InputError "FILE:LINE: KEY: ..." if it is incomplete or has an unknown key or a wrong
/// value.
ImportMap load_import_map(const std::filesystem::path& file);
/// The same from text; `file` appears in messages, and paths are relative to its folder.
ImportMap parse_import_map(const std::string& text, const std::filesystem::path& file);

/// "macro_command" of "macro_command [V]".
std::string_view name_of_title(std::string_view title);
/// "V"; empty without a unit.
std::string_view unit_of_title(std::string_view title);

}  // namespace fidservo::imports
