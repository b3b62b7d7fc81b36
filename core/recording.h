// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A recording in memory: one row per control tick, and the fiducials seen. Row k holds what was sampled at
// tick k and the commands applied from tick k on (the voltages sent, after saturation).
#include "core/appearance.h"
#include "core/detection.h"
#include "core/plate.h"
#include "core/time.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace fidservo {

/// The value of a field that does not apply at a tick; in the file the field is empty.
inline constexpr double not_in_force = std::numeric_limits<double>::quiet_NaN();

/// A tick: what was sampled, and what was commanded from then on.
struct StageRow {
    TimeNs time_ns = 0;                       ///< of the sampling
    double macro_setpoint_mm = not_in_force;  ///< target position of the macro stage
    double macro_command_V = not_in_force;    ///< sent to the motor
    double encoder_count = not_in_force;      ///< the encoder's reading, since power came on
    double micro_setpoint_mm = not_in_force;  ///< target position of the platform
    double micro_command_V = not_in_force;    ///< sent to the heater
    double hall_adc = not_in_force;           ///< the Hall sensor's reading
    /// Carriage position, in files that give it in place of the encoder's count.
    double position_mm = not_in_force;
};

/// Which columns a recording has; a rig may lack some.
struct StageColumns {
    /// Columns of the macro stage: StageRow::macro_setpoint_mm and so on.
    bool macro_setpoint = false, macro_command = false, encoder = false;
    /// Columns of the micro stage: StageRow::micro_setpoint_mm and so on.
    bool micro_setpoint = false, micro_command = false, hall = false;
    bool position = false;  ///< the file gave "position [mm]" in place of "encoder [count]"
};

/// Offset of the encoder's count. An incremental encoder counts from wherever power came on.
struct EncoderZero {
    double count = 0.0;      ///< the reading with the carriage at place 0 of the rig's travel
    double std_count = 0.0;  ///< standard deviation of count
    std::string how;         ///< how the offset is known, in words
};

/// Which of the rig file's controllers (nonlinear_pd, benchmark_pid, pi_antiwindup) gave the commands
/// wherever the stage's setpoint is in force. Under any other name a diagnosis takes the commands as given
/// and does not model the controller.
struct ControllerNames {
    /// Controller of the macro and of the micro stage; empty: none.
    std::string macro, micro;
};

/// Something that happened while a recording was made.
struct RecordingEvent {
    TimeNs time_ns = 0;  ///< when
    std::string what;    ///< homing, end_stop, frames_lost, ...
    std::string text;    ///< in words
};

/// A frame and the file of its image.
struct FrameName {
    TimeNs time_ns;        ///< middle of its exposure
    std::string filename;  ///< relative to the recording's cam0/data
};

/// Index of the last row up to a time; 0 before all of them. The rows are in the order of time, and there is
/// at least one.
inline std::size_t row_at(const std::vector<StageRow>& rows, TimeNs time_ns) {
    const auto after = std::ranges::upper_bound(rows, time_ns, {}, &StageRow::time_ns);
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - rows.begin() - 1));
}

/// What holds for the whole of a recording, and for every part of it.
struct RecordingHeader {
    std::string name;                            ///< of the recording
    std::string rig;                             ///< name of the rig, as the rig file states it
    std::string experiment;                      ///< what was done, in words
    double tick_s = 0.0;                         ///< time from row to row
    std::optional<EncoderZero> encoder_zero;     ///< empty: not stated
    std::optional<ControllerNames> controllers;  ///< empty: not stated
    std::vector<PlateTag> plate;                 ///< the tags that were seen; empty: those of the rig file
    bool is_unfinished = false;  ///< the program that made it ended before the recording was complete
    bool is_seen = false;        ///< detections are from a camera's images, not simulated directly
    StageColumns columns;        ///< which columns of StageRow the recording has
    /// Resolution of macro_setpoint_mm in the file: one unit of its last digit.
    double macro_setpoint_step_mm = 1e-4;
};

/// A whole recording. Rows, detections and frames are in the order of time.
struct Recording : RecordingHeader {
    std::vector<RecordingEvent> events;    ///< in the order of time
    std::vector<StageRow> rows;            ///< one a tick
    std::vector<TagDetection> detections;  ///< of all frames
    std::vector<FrameName> frames;         ///< those whose images are kept
    /// of some detections, where frames were measured; in the order of time.
    std::vector<TagAppearance> appearances;
};

}  // namespace fidservo
