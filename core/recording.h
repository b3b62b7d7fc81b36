#pragma once
// A recording in memory: one row per control tick, and the fiducials seen. Row k holds what was sampled at
// tick k and the commands applied from tick k on (the voltages sent, after saturation).
#include "core/appearance.h"
#include "core/detection.h"
#include "core/time.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace fidservo {

/// "Not in force": an empty field of the file.
inline constexpr double not_in_force = std::numeric_limits<double>::quiet_NaN();

struct StageRow {
    TimeNs time_ns = 0;
    double macro_setpoint_mm = not_in_force;
    double macro_command_V = not_in_force;
    double encoder_count = not_in_force;
    double micro_setpoint_mm = not_in_force;
    double micro_command_V = not_in_force;
    double hall_adc = not_in_force;
    double position_mm = not_in_force;  ///< in files that give it in place of a count
};

/// Which columns a recording has; a rig may lack some.
struct StageColumns {
    bool macro_setpoint = false, macro_command = false, encoder = false;
    bool micro_setpoint = false, micro_command = false, hall = false;
    bool position = false;  ///< the file gave "position [mm]" in place of "encoder [count]"
};

struct FrameName {
    TimeNs time_ns;
    std::string filename;  ///< relative to the recording's cam0/data
};

/// The last row up to a time; the first one before all of them. Rows in the order of time, one at least.
inline std::size_t row_at(const std::vector<StageRow>& rows, TimeNs time_ns) {
    const auto after = std::ranges::upper_bound(rows, time_ns, {}, &StageRow::time_ns);
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - rows.begin() - 1));
}

struct Recording {
    std::string name;
    std::string rig;
    std::string experiment;
    double tick_s = 0.0;
    StageColumns columns;
    std::vector<StageRow> rows;
    std::vector<TagDetection> detections;
    std::vector<FrameName> frames;
    std::vector<TagAppearance> appearances;  ///< of some detections, where frames were measured; by time
};

}  // namespace fidservo
