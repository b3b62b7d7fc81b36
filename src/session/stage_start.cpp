// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/stage_start.h"

#include "control/stage_check.h"
#include "core/failure.h"
#include "core/input_error.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace fidservo {

void check_stage(Pilot& pilot) {
    const control::StageCheckParams params = control::stage_check_params(pilot.rig);
    control::StageCheckState state;
    const auto checked = pilot.machine.run(
        [&](const control::StageSample& sample) {
            return control::stage_check_update(params, state, sample);
        },
        [&] { return control::stage_check_is_done(state); });
    if (!checked)
        throw RunFault(
            fmt::format("the stage's check: {}: {}", name_of(checked.error().reason), checked.error().text));
    if (state.phase == control::StageCheckPhase::failed)
        throw RunFault(fmt::format("the stage does not answer as it should: {}", state.why));
    spdlog::info("the stage answers: carriage by {:.2f} mm, platform by heat", state.moved_mm);
}

std::string text_of(const control::LoopStatistics& loop) {
    const auto us = [&](double share) { return microseconds(loop.lateness.quantile_ns(share)); };
    std::string text = fmt::format(
        "{} ticks, late by {:.0f} us (median), {:.0f} us (99 %), {:.0f} us at most; {} overruns, {} held",
        loop.ticks, us(0.5), us(0.99), us(1.0), loop.overruns, loop.held);
    if (!loop.real_time_priority) text += "; SCHED_FIFO is not permitted (ulimit -r, CAP_SYS_NICE)";
    if (!loop.memory_locked) text += "; locked memory is not permitted (ulimit -l, CAP_IPC_LOCK)";
    return text;
}

}  // namespace fidservo
