// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The supervisor of a motion to a fiducial-relative target, ticked at 1 kHz.
//
//   macro_move   the macro stage goes where the micro stage can do the rest     } skipped where the micro
//   macro_settle motor off; encoder quiet                                       } stage reaches it alone
//   look         frames at rest say how far it still is; two that agree confirm the rest
//   micro_move   one approach without hunting (micro_controller.h)
//   micro_settle the controller's hold phase takes over
//   ...          look again; correct until within tolerance; re-centre where the micro stroke does not
//   suffice
//
// What the camera saw enters as the distance still to go at the middle of a frame's exposure, so the
// supervisor never sees an image; a frame exposed before the stage came to rest is not used, however late it
// arrives.
#include "control/macro_controller.h"
#include "control/micro_controller.h"
#include "control/stage.h"
#include "core/failure.h"
#include "core/result.h"

#include <array>
#include <cstdint>
#include <optional>

namespace fidservo::control {

/// Distance from the camera's axis to the target along the stage axis, mm, at the middle of a frame's
/// exposure.
struct TargetOffset {
    TimeNs time_ns;    ///< middle of the exposure
    double needed_mm;  ///< distance still to go
    double std_mm;     ///< standard deviation of needed_mm
};

/// Parameters of a rig's positioning.
struct PositionerParams {
    MacroControllerParams macro;         ///< the macro controller's
    MicroControllerParams micro;         ///< the micro controller's
    double count_mm;                     ///< the encoder's resolution, mm per count
    double reach_low_mm, reach_high_mm;  ///< range of platform positions that moves may end at
    /// Range of platform positions that a macro move leaves as they are; from outside it brings the
    /// platform's goal to the range's middle.
    double park_low_mm, park_high_mm;
    double tolerance_mm = 0.001;    ///< a motion has arrived within this distance of its target
    double micro_settle_s = 0.030;  ///< time given to the hold phase before frames are used
    /// Standard deviation by which a stage at rest may shake or creep from frame to frame. Two frames confirm
    /// that it is at rest if they differ by at most four standard deviations of their difference, this
    /// included.
    double rest_std_mm = 0.0001;
    double look_timeout_s = 0.5;   ///< time without a frame that is a fault
    double macro_timeout_s = 8.0;  ///< time within which the carriage must have come to rest
    /// The carriage counts as arrived within so many counts: the micro stage does the rest.
    int macro_near_count = 1;
    int most_moves = 8;  ///< micro moves in one motion, at most
    /// Macro moves, in one motion, that bring the target back into the platform's reach, at most.
    int most_recentres = 3;
};

/// Where a motion is; the top of control/positioner.h says what each phase does.
enum class PositionerPhase : std::uint8_t {
    idle,          ///< no motion yet
    macro_move,    ///< the carriage moves
    macro_settle,  ///< the carriage comes to rest
    look,          ///< frames tell the distance still to go
    micro_move,    ///< the platform moves
    micro_settle,  ///< the micro controller's hold phase takes over
    arrived,       ///< within tolerance
    failed         ///< PositionerState::why has the reason
};

/// The range of encoder counts to which the carriage may be sent.
struct CarriageTravel {
    /// The lowest and the highest.
    double low_count, high_count;
};

/// All that the supervisor remembers from tick to tick.
struct PositionerState {
    PositionerPhase phase = PositionerPhase::idle;  ///< the phase of the motion
    MacroControllerState macro;                     ///< state of the macro controller
    MicroControllerState micro;                     ///< state of the micro controller
    CarriageTravel travel{};                        ///< counts to which the carriage may be sent
    Reason why = Reason::no_convergence;            ///< the reason for a failure
    double phase_s = 0.0;                           ///< time since the phase began
    double move_s = 0.0;                            ///< time since the motion began
    double macro_s = 0.0;                 ///< time from the motion's begin until the macro stage was at rest
    double micro_s = 0.0;                 ///< time since the motion's first micro move began
    TimeNs rest_since_ns = 0;             ///< since when the stage has been at rest
    std::array<TargetOffset, 2> looks{};  ///< what the last two frames at rest said
    int frames = 0;                       ///< frames used since the stage came to rest
    TargetOffset reached{};               ///< combine_looks() of the two frames that agreed
    int moves = 0;                        ///< micro moves of this motion so far
    int recentres = 0;                    ///< macro moves of this motion so far that re-centred the platform
};

/// What the supervisor asks for in a tick.
struct PositionerOutput {
    StageCommand command;       ///< for the stage, until the next tick
    bool wants_frames = false;  ///< whether frames are needed
};

/// The state of a stage at rest, without heat.
PositionerState positioner_start(const PositionerParams& params);

/// Begins a motion.
/// @param needed_mm  distance to go, known from the registration to within a fraction of the field of view
void positioner_begin(const PositionerParams& params, PositionerState& state, double needed_mm,
                      const CarriageTravel& travel);

/// One tick.
/// @param seen  the offset in a frame that has just arrived, if one has
PositionerOutput positioner_update(const PositionerParams& params, PositionerState& state,
                                   const StageSample& sample, const std::optional<TargetOffset>& seen);

/// The offset from two frames of a stage at rest, at the time of the later one: the mean with the weights w =
/// 1 / (std^2 + t^2), and std^2 = 1 / sum w. t^2 is 0 where the frames' own uncertainties explain their
/// difference d, and else the variance between frames that does, (d^2 - std_0^2 - std_1^2) / 2, so that a
/// stage that shakes, or a camera that is worse than stated, enlarges the result's uncertainty. Source:
/// Mandel and Paule, "Interlaboratory evaluation of a material with unequal numbers of replicates",
/// Analytical Chemistry 42(11), 1970. Demands positive standard deviations.
TargetOffset combine_looks(const TargetOffset& before, const TargetOffset& now);

/// Whether a motion has ended, well or badly.
bool positioner_is_done(const PositionerState& state);

}  // namespace fidservo::control
