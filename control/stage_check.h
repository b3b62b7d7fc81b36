// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether a stage is there, before anything is entrusted to it: a driver answers without a board, and a board
// without a stage. The motor is pushed shortly, first one way and, where that moves nothing, the other way
// and harder; the wire is heated until the Hall sensor shows it, and cools down again.
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
    double move_mm = 2.0;                ///< that a push is good for, by the rig file's numbers
    double least_share = 0.25;           ///< of it that counts as an answer
    double most_share = 4.0;             ///< beyond it the answer is not believed
    double coast_s = 0.25;               ///< after a push
    double rest_s = 0.1;                 ///< looked at before anything is pushed
    double hall_low_adc, hall_high_adc;  ///< readings that the travel has, with a margin
    double hall_answer_adc;              ///< change that counts as an answer
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
    double phase_s = 0.0;   ///< since the phase began, by the samples' times: the loop may have been late
    double pushed_s = 0.0;  ///< how long the last push was
    int attempt = 0;
    std::int64_t start_count = 0;
    double hall_sum = 0.0;
    int hall_samples = 0;
    std::optional<int> lowest_hall_adc;  ///< since the wire is heated
    std::string why;                     ///< of a failure: one line
    double moved_mm = 0.0;               ///< by the push that was answered
};

/// One tick. @return the commands from this tick on; zero once the check has ended
StageCommand stage_check_update(const StageCheckParams& params, StageCheckState& state,
                                const StageSample& sample);

bool stage_check_is_done(const StageCheckState& state);

}  // namespace fidservo::control
