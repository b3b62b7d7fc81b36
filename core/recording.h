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

/// "Not in force": an empty field of the file.
inline constexpr double not_in_force = std::numeric_limits<double>::quiet_NaN();

/// A tick: what was sampled, and what was commanded from then on.
struct StageRow {
    TimeNs time_ns = 0;                       ///< of the sampling
    double macro_setpoint_mm = not_in_force;  ///< of the macro stage
    double macro_command_V = not_in_force;    ///< sent to the motor
    double encoder_count = not_in_force;      ///< the encoder's reading, since power came on
    double micro_setpoint_mm = not_in_force;  ///< of the platform
    double micro_command_V = not_in_force;    ///< sent to the heater
    double hall_adc = not_in_force;           ///< the Hall sensor's reading
    double position_mm = not_in_force;        ///< in files that give it in place of a count
};

/// Which columns a recording has; a rig may lack some.
struct StageColumns {
    /// Of the macro stage: StageRow::macro_setpoint_mm and so on.
    bool macro_setpoint = false, macro_command = false, encoder = false;
    /// Of the micro stage: StageRow::micro_setpoint_mm and so on.
    bool micro_setpoint = false, micro_command = false, hall = false;
    bool position = false;  ///< the file gave "position [mm]" in place of "encoder [count]"
};

/// Where the encoder counts from. An incremental one begins at zero wherever the power comes on.
struct EncoderZero {
    double count = 0.0;      ///< the reading with the carriage at place 0 of the rig's travel
    double std_count = 0.0;  ///< one standard deviation
    std::string how;         ///< how that is known, in words
};

/// Which controller was in charge wherever its stage's setpoint is in force: the rig file's, by the names
/// nonlinear_pd, benchmark_pid and pi_antiwindup. Under any other name commands are given, not to be
/// explained.
struct ControllerNames {
    /// By the names that the rig file gives them; empty: none.
    std::string macro, micro;
};

/// Something that happened while a recording was made.
struct RecordingEvent {
    TimeNs time_ns = 0;  ///< when
    std::string what;    ///< homing, end_stop, frames_lost, ...
    std::string text;    ///< in words
};

/// A frame's image, by its file.
struct FrameName {
    TimeNs time_ns;        ///< middle of its exposure
    std::string filename;  ///< relative to the recording's cam0/data
};

/// The last row up to a time; the first one before all of them. Rows in the order of time, one at least.
inline std::size_t row_at(const std::vector<StageRow>& rows, TimeNs time_ns) {
    const auto after = std::ranges::upper_bound(rows, time_ns, {}, &StageRow::time_ns);
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - rows.begin() - 1));
}

/// What holds for the whole of a recording, and for every part of it.
struct RecordingHeader {
    std::string name;                            ///< of the recording
    std::string rig;                             ///< by the rig file's name
    std::string experiment;                      ///< what was done, in words
    double tick_s = 0.0;                         ///< from row to row
    std::optional<EncoderZero> encoder_zero;     ///< empty: not stated
    std::optional<ControllerNames> controllers;  ///< likewise
    std::vector<PlateTag> plate;                 ///< that it was made over; empty: the one of the rig file
    bool is_unfinished = false;                  ///< whoever made it was ended in the middle
    bool is_seen = false;                        ///< detections are what was found in a camera's images
    StageColumns columns;                        ///< which of its fields a row has
    double macro_setpoint_step_mm = 1e-4;        ///< of the last digit that its file has
};

/// All of it. Rows, detections and frames are in the order of time.
struct Recording : RecordingHeader {
    std::vector<RecordingEvent> events;      ///< by time
    std::vector<StageRow> rows;              ///< tick by tick
    std::vector<TagDetection> detections;    ///< frame by frame
    std::vector<FrameName> frames;           ///< whose images are kept
    std::vector<TagAppearance> appearances;  ///< of some detections, where frames were measured; by time
};

}  // namespace fidservo
