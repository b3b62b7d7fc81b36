// SPDX-License-Identifier: GPL-3.0-or-later
// Controllers replayed on recordings: the rig file's, in every way in which firmware may read setpoints and
// counts.
#include "gap/links/controller_link.h"

#include "control/nonlinear_pd.h"
#include "core/rig.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

/// A carriage that creeps to two setpoints in turn under a PD whose firmware reads setpoints and counts in
/// its own way.
struct Firmware {
    double setpoint_mm = 102.30;
    double setpoint_count = 2046.0;
    std::size_t delay_rows = 0;
    double gain = 1.0;  ///< times the file's
};

Recording controlled_by(const Firmware& firmware) {
    const Rig& rig = reference_rig();
    PdGains gains = *rig.macro.pd;
    gains.e0_V_per_count *= firmware.gain;
    gains.e1_V_per_count *= firmware.gain;
    Recording recording;
    recording.tick_s = rig.tick_s;
    recording.controllers = ControllerNames{"nonlinear_pd", ""};
    control::PdState state;
    constexpr std::size_t rows = 1500;
    for (std::size_t k = 0; k < rows; ++k) {
        StageRow row;
        row.time_ns = nanoseconds(static_cast<double>(k) * rig.tick_s);
        row.macro_setpoint_mm = firmware.setpoint_mm;
        row.encoder_count = std::floor(2000.0 + 0.05 * static_cast<double>(k));
        recording.rows.push_back(row);
        const std::size_t sampled = k - std::min(k, firmware.delay_rows);
        recording.rows[k].macro_command_V =
            control::pd_update(gains, rig.macro.command_limit_V, state,
                               firmware.setpoint_count - recording.rows[sampled].encoder_count);
    }
    return recording;
}

/// The largest error of all windows; empty without windows.
std::optional<double> largest_error_V(const Recording& recording) {
    const gap::ControllerRun run = gap::macro_controller_run(recording, reference_rig());
    if (run.windows.empty()) return std::nullopt;
    double largest_V = 0.0;
    for (const gap::WindowRows& window : run.windows)
        for (std::size_t k = window.first; k < window.end; ++k)
            if (std::isfinite(run.error_V[k])) largest_V = std::max(largest_V, std::abs(run.error_V[k]));
    return largest_V;
}

constexpr double nothing_V = 1e-9, something_V = 1e-3;

TEST(ControllerLink, EveryReadingOfFirmware_IsTheFilesController) {
    EXPECT_LT(largest_error_V(controlled_by({})).value(), nothing_V);
    // Rounded half way between two counts.
    EXPECT_LT(largest_error_V(controlled_by({102.275, 2045.0})).value(), nothing_V);
    EXPECT_LT(largest_error_V(controlled_by({102.275, 2046.0})).value(), nothing_V);
    // Truncated.
    EXPECT_LT(largest_error_V(controlled_by({102.29, 2045.0})).value(), nothing_V);
    // With a count that is one tick old.
    EXPECT_LT(largest_error_V(controlled_by({102.30, 2046.0, 1})).value(), nothing_V);
}

/// The recording as restored from a file with this number of decimals.
Recording in_a_file_of(int decimals, Recording recording) {
    recording.macro_setpoint_step_mm = std::pow(10.0, -decimals);
    for (StageRow& row : recording.rows)
        row.macro_setpoint_mm = recording.macro_setpoint_step_mm *
                                std::round(row.macro_setpoint_mm / recording.macro_setpoint_step_mm);
    return recording;
}

TEST(ControllerLink, SetpointMayBeWhatItsLastDigitLeavesOpen_AndNoMore) {
    // 102.2741 mm are 2045.482 counts: no more than 2045.
    const Recording below = controlled_by({102.2741, 2045.0}), above = controlled_by({102.2741, 2046.0});
    for (const int decimals : {2, 3, 4, 5})
        EXPECT_LT(largest_error_V(in_a_file_of(decimals, below)).value(), nothing_V) << decimals;
    EXPECT_GT(largest_error_V(in_a_file_of(5, above)).value(), something_V);
    EXPECT_GT(largest_error_V(in_a_file_of(4, above)).value(), something_V);
    EXPECT_GT(largest_error_V(in_a_file_of(3, above)).value(), something_V);
    EXPECT_LT(largest_error_V(in_a_file_of(2, above)).value(), nothing_V);
    // 102.27497 mm are 2045.4994 counts, which four digits round to a tie.
    const Recording near_tie = controlled_by({102.27497, 2046.0});
    EXPECT_LT(largest_error_V(in_a_file_of(4, near_tie)).value(), nothing_V);
    EXPECT_GT(largest_error_V(in_a_file_of(5, near_tie)).value(), something_V);
    // With one decimal a setpoint is compatible with three counts.
    for (const double count : {2045.0, 2046.0, 2047.0})
        EXPECT_LT(largest_error_V(in_a_file_of(1, controlled_by({102.3, count}))).value(), nothing_V)
            << count;
    EXPECT_GT(largest_error_V(in_a_file_of(1, controlled_by({102.3, 2049.0}))).value(), something_V);
}

TEST(ControllerLink, OtherGainsOrAnotherCount_AreNot) {
    EXPECT_GT(largest_error_V(controlled_by({102.30, 2046.0, 0, 1.2})).value(), something_V);
    EXPECT_GT(largest_error_V(controlled_by({102.30, 2049.0})).value(), something_V);
}

TEST(ControllerLink, StartInTheMiddle_KnowsItsStateARowLater) {
    Recording recording = controlled_by({});
    recording.rows.erase(recording.rows.begin(), recording.rows.begin() + 300);
    EXPECT_LT(largest_error_V(recording).value(), nothing_V);
}

TEST(ControllerLink, CommandsOfAControllerThatIsNotClaimed_AreGiven) {
    Recording recording = controlled_by({102.30, 2046.0, 0, 1.2});
    recording.controllers->macro = "feed-forward";
    EXPECT_FALSE(largest_error_V(recording).has_value());
    recording.controllers.reset();
    recording.experiment = "site-017";
    EXPECT_FALSE(largest_error_V(recording).has_value());
    recording.experiment = "macro-square";
    EXPECT_GT(largest_error_V(recording).value(), something_V);
}

}  // namespace

}  // namespace fidservo
