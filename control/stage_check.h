// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A check that the stage is connected and answers, before it is used: a driver answers without a board, and a
// board without a stage. The motor is pushed shortly, first one way and, where that moves nothing, the other
// way and harder; then the wire is heated until the Hall sensor shows it, and cools down again.
#include "control/stage.h"
#include "core/macro_parameters.h"

#include <cstdint>
#include <optional>
#include <string>

namespace fidservo {
struct Rig;
}

namespace fidservo::control {

struct StageCheckParams {
    MacroParameters macro;
    double move_mm = 2.0;       ///< distance that a push is to move the carriage by the rig file's model
    double least_share = 0.25;  ///< fraction of move_mm from which a motion counts as an answer
    double most_share = 4.0;  ///< multiple of the predicted distance beyond which the answer is not believed
    double coast_s = 0.25;    ///< time given to the carriage to come to rest after a push
    double rest_s = 0.1;      ///< time for which a stage at rest is observed before the first push
    double hall_low_adc, hall_high_adc;  ///< range of readings over the travel, with a margin
    double hall_answer_adc;              ///< change of the reading that counts as an answer
    double heat_V;
    double heat_limit_s = 4.0;
    double cool_s;
};

/// @param rig  must have a micro stage
StageCheckParams stage_check_params(const Rig& rig);

enum class StageCheckPhase : std::uint8_t { rest, push, coast, back, settle, heat, cool, passed, failed };

struct StageCheckState {
    StageCheckPhase phase = StageCheckPhase::rest;
    std::optional<TimeNs> phase_start_ns;
    /// Time since the phase began, by the samples' time stamps, since the loop may have been late.
    double phase_s = 0.0;
    double pushed_s = 0.0;  ///< duration of the last push
    int attempt = 0;
    std::int64_t start_count = 0;
    double hall_sum = 0.0;
    int hall_samples = 0;
    std::optional<int> lowest_hall_adc;  ///< lowest reading since heating began
    std::string why;                     ///< the reason for a failure, one line
    double moved_mm = 0.0;               ///< distance that the push which was answered moved the carriage
};

/// One tick. @return the commands from this tick on; zero once the check has ended
StageCommand stage_check_update(const StageCheckParams& params, StageCheckState& state,
                                const StageSample& sample);

bool stage_check_is_done(const StageCheckState& state);

}  // namespace fidservo::control
