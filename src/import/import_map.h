// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The map that binds a log's signals to a recording: format fidservo-map/1 (docs/import.md).
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

/// One signal of the log, as the map asks for it.
struct SignalChoice {
    std::string signal;
    std::string unit;     ///< empty: as the file states
    double factor = 1.0;  ///< of the recording's unit in one of the signal's, after any conversion
    bool has_factor = false;
    double offset = 0.0;             ///< in the recording's unit, added after the factor
    std::string clock;               ///< empty: the signal's own times, or the map's first clock
    std::optional<bool> is_held;     ///< between samples: the last value, or a straight line
    std::optional<int> decimals;     ///< that the log's numbers are rounded to
    std::optional<YamlValue> where;  ///< in the map, for messages
};

/// Two signals that see the same motion, the first on the clock that is fitted.
struct ClockFitChoice {
    std::string signal, to;
};

/// Time of the recording = offset + (1 + rate 1e-6) time of the clock, s.
struct ClockChoice {
    std::string name;
    SignalChoice times;  ///< signal empty: rate_hz, or each signal's own
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
    Recording stated;  ///< what `recording` says; tick_s 0: not said
    RecordingOrigin origin;
    TableOptions table;
    std::vector<ClockChoice> clocks;                 ///< the first is the recording's
    std::map<std::string, SignalChoice> columns;     ///< by the column's name without its unit
    std::map<std::string, SignalChoice> detections;  ///< tag_id, p0_x, ..
    std::string detections_clock;
    std::optional<CameraChoice> camera;
    std::filesystem::path plate;  ///< empty: none

    const ClockChoice* clock(std::string_view name) const;
};

/// Throws InputError "FILE:LINE: KEY: ..." on anything but a whole map.
ImportMap load_import_map(const std::filesystem::path& file);
/// The same from text; `file` appears in messages, and paths are relative to its folder.
ImportMap parse_import_map(const std::string& text, const std::filesystem::path& file);

/// "macro_command" of "macro_command [V]".
std::string_view name_of_title(std::string_view title);
/// "V"; empty without a unit.
std::string_view unit_of_title(std::string_view title);

}  // namespace fidservo::imports
