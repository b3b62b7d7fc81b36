// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The names and columns of a recording folder, for reader and writer alike (docs/formats.md).
#include "core/recording.h"

#include <array>
#include <string_view>

namespace fidservo {

inline constexpr std::string_view recording_format = "fidservo-recording/1";

/// How recordings name controllers: the rig file's, and the session's motion control.
namespace controller_name {
inline constexpr std::string_view nonlinear_pd = "nonlinear_pd", benchmark_pid = "benchmark_pid",
                                  pi_antiwindup = "pi_antiwindup", positioner = "positioner";
}

inline constexpr std::string_view time_title = "timestamp [ns]";

/// A column of stage0/data.csv after the time.
struct StageColumn {
    std::string_view title;
    double StageRow::*value;
    bool StageColumns::*present;
    int decimals;  ///< digits after the decimal point
};

/// In the order of the file.
inline constexpr std::array stage_columns{
    StageColumn{"macro_setpoint [mm]", &StageRow::macro_setpoint_mm, &StageColumns::macro_setpoint, 4},
    StageColumn{"macro_command [V]", &StageRow::macro_command_V, &StageColumns::macro_command, 7},
    StageColumn{"encoder [count]", &StageRow::encoder_count, &StageColumns::encoder, 0},
    StageColumn{"position [mm]", &StageRow::position_mm, &StageColumns::position, 6},
    StageColumn{"micro_setpoint [mm]", &StageRow::micro_setpoint_mm, &StageColumns::micro_setpoint, 7},
    StageColumn{"micro_command [V]", &StageRow::micro_command_V, &StageColumns::micro_command, 7},
    StageColumn{"hall [adc]", &StageRow::hall_adc, &StageColumns::hall, 0}};

inline constexpr std::array<std::string_view, 8> corner_titles{
    "p0_x [px]", "p0_y [px]", "p1_x [px]", "p1_y [px]", "p2_x [px]", "p2_y [px]", "p3_x [px]", "p3_y [px]"};
inline constexpr int corner_decimals = 4;

/// Optional columns of a detections file: whether the corners were refined (1) or are as the detector found
/// them (0), and the covariance of x and y of each corner.
inline constexpr std::string_view refined_title = "refined";
inline constexpr std::array<std::string_view, 12> covariance_titles{
    "p0_xx [px^2]", "p0_xy [px^2]", "p0_yy [px^2]", "p1_xx [px^2]", "p1_xy [px^2]", "p1_yy [px^2]",
    "p2_xx [px^2]", "p2_xy [px^2]", "p2_yy [px^2]", "p3_xx [px^2]", "p3_xy [px^2]", "p3_yy [px^2]"};

}  // namespace fidservo
