// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The supervisor of a motion to a fiducial-relative target, ticked at 1 kHz.
//
//   macro_move   the macro stage goes where the micro stage can do the rest     } skipped where the micro
//   macro_settle motor off; encoder quiet                                       } stage reaches it alone
//   look         frames at rest say how far it still is; two that agree confirm the rest
//   micro_move   one approach without hunting (micro_controller.h)
//   micro_settle the hold takes over
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

/// From the camera's axis to the target along the stage axis, mm, at the middle of a frame's exposure.
struct TargetOffset {
    TimeNs time_ns;    ///< middle of the exposure
    double needed_mm;  ///< distance still to go
    double std_mm;     ///< one standard deviation
};

/// What a rig's positioning needs.
struct PositionerParams {
    MacroControllerParams macro;         ///< of the macro controller
    MicroControllerParams micro;         ///< of the micro controller
    double count_mm;                     ///< of the encoder, mm per count
    double reach_low_mm, reach_high_mm;  ///< platform positions that moves may end at
    double park_low_mm, park_high_mm;    ///< positions that the macro stage leaves as they are
    double tolerance_mm = 0.001;         ///< within which a motion has arrived
    double micro_settle_s = 0.030;       ///< how long the hold is given to take over
    /// What a stage at rest may shake or creep by from frame to frame, one standard deviation. Two frames
    /// confirm the rest if they differ by no more than four of this and of their own together.
    double rest_std_mm = 0.0001;
    double look_timeout_s = 0.5;   ///< after which no frame has come: a fault
    double macro_timeout_s = 8.0;  ///< after which the carriage has not come
    int macro_near_count = 1;      ///< the PD's last nudges are left to the micro stage
    int most_moves = 8;            ///< of the micro stage, in one motion
    int most_recentres = 3;        ///< of the carriage, in one motion
};

/// Where a motion is; the top of control/positioner.h says what each phase does.
enum class PositionerPhase : std::uint8_t {
    idle,          ///< no motion yet
    macro_move,    ///< the carriage goes
    macro_settle,  ///< it comes to rest
    look,          ///< frames tell what is left
    micro_move,    ///< the platform goes
    micro_settle,  ///< the hold takes over
    arrived,       ///< within tolerance
    failed         ///< PositionerState::why
};

/// Encoder counts between which the carriage may be sent.
struct CarriageTravel {
    /// The lowest and the highest.
    double low_count, high_count;
};

/// All that the supervisor remembers from tick to tick.
struct PositionerState {
    PositionerPhase phase = PositionerPhase::idle;  ///< where the motion is
    MacroControllerState macro;                     ///< of the macro controller
    MicroControllerState micro;                     ///< of the micro controller
    CarriageTravel travel{};                        ///< between which the carriage may be sent
    Reason why = Reason::no_convergence;            ///< of a failure
    double phase_s = 0.0;                           ///< since the phase began
    double move_s = 0.0;                            ///< since the motion began
    double macro_s = 0.0;                           ///< of the motion: until the macro stage was settled
    double micro_s = 0.0;                           ///< of the motion: since the first micro move
    TimeNs rest_since_ns = 0;                       ///< since when the stage has been at rest
    std::array<TargetOffset, 2> looks{};            ///< the last frames at rest
    int frames = 0;                                 ///< looks so far, at this rest
    TargetOffset reached{};                         ///< combine_looks() of those that agreed
    int moves = 0;                                  ///< of the micro stage, so far
    int recentres = 0;                              ///< of the carriage, so far
};

/// What the supervisor asks for in a tick.
struct PositionerOutput {
    StageCommand command;       ///< for the stage, until the next tick
    bool wants_frames = false;  ///< whether the camera should look
};

/// A stage at rest, without heat.
PositionerState positioner_start(const PositionerParams& params);

/// Begins a motion. @param needed_mm  distance to go as the registration knows it, good to a fraction of the
/// view
void positioner_begin(const PositionerParams& params, PositionerState& state, double needed_mm,
                      const CarriageTravel& travel);

/// One tick.
/// @param seen  what a frame that has just arrived says, if one has
PositionerOutput positioner_update(const PositionerParams& params, PositionerState& state,
                                   const StageSample& sample, const std::optional<TargetOffset>& seen);

/// One offset from two looks at a stage at rest, at the time of the later one: the mean with the weights
/// w = 1 / (std^2 + t^2), and std^2 = 1 / sum w. t^2 is 0 where the looks' own uncertainties explain their
/// difference, and else the variance between looks that does, (d^2 - std_0^2 - std_1^2) / 2: a stage that
/// shakes, or a camera that is worse than it says, counts in the result. Source: Mandel and Paule,
/// "Interlaboratory evaluation of a material with unequal numbers of replicates", Analytical Chemistry
/// 42(11), 1970. Demands positive standard deviations.
TargetOffset combine_looks(const TargetOffset& before, const TargetOffset& now);

/// Whether a motion has ended, well or badly.
bool positioner_is_done(const PositionerState& state);

}  // namespace fidservo::control
