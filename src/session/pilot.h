// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The rig under way: machine, sight and positioner together, and the registration that tells where the camera
// is.
#include "control/positioner.h"
#include "core/failure.h"
#include "core/plate.h"
#include "core/result.h"
#include "core/rig.h"
#include "src/session/machine.h"
#include "src/session/sight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace fidservo {

/// Where the camera looks for a fiducial that is not where it should be: offsets along the stage axis, mm.
inline constexpr std::array search_offsets_mm{0.0, 0.7, -0.7};

inline tl::unexpected<Failure> forward(Failure why) {
    return tl::make_unexpected(std::move(why));
}

class Pilot {
  public:
    /// The rig must have all that `params` were made of (motion_params.h).
    /// @param camera_reconnect_s  a camera that is lost is waited for so long
    Pilot(const Rig& rig, const Plate& nominal, const control::PositionerParams& params, Devices devices,
          double camera_reconnect_s = 0.0);

    /// Where the registration believes the camera to be, plate x, mm.
    double believed_s_mm() const;
    /// What a frame has just shown moves the registration, not the rig. Much of a move is logged: counts were
    /// lost, or the carriage was pushed.
    /// @param tag_id  of the tag that was seen
    void register_at(double s_mm, int tag_id);
    /// The end stop is good to a count.
    void register_at_end_stop(std::int64_t stop_count);

    /// Where the encoder counts from, by the registration; empty before homing.
    std::optional<EncoderZero> encoder_zero() const;

    /// Where the registration believes the carriage to be, mm.
    double carriage_mm() const;
    /// The carriage's travel in encoder counts, by the registration.
    control::CarriageTravel carriage_travel() const;

    /// One tick of the positioner.
    Status step();
    /// The positioner sees what went by while nobody controlled: before a motion begins. Nothing in virtual
    /// time.
    Status catch_up();

    /// Ticks until a condition holds. Fails with Reason::timeout.
    Status step_until(const std::predicate auto& condition, double timeout_s, const char* what) {
        const long most = std::lround(timeout_s / rig.tick_s);
        long ticks = 0;
        auto ended = move([&] { return condition() || ticks++ > most; });
        if (ended && !condition()) return failure(Reason::timeout, what);
        return ended;
    }

    /// The stage was moved by others: from where it is now, the motor off, the wire without heat.
    void begin_anew();

    /// The next frame exposed wholly after a time, in true exposure time. Fails with Reason::timeout.
    Result<vision::Frame> next_frame(TimeNs after_ns);
    /// A frame's true middle of exposure: its stamp without the delay that the tuning found.
    TimeNs exposed_at(const vision::Frame& frame) const;

    /// Brings the macro stage so that the camera stands at s, by the registration alone; nothing is
    /// confirmed.
    Status carry_to(double s_mm);
    /// Brings the carriage to its place `carriage_mm`, by the registration, and to rest within a count of it.
    /// Where commands or readings come so late that the controller's nudges go on, a few counts.
    Status place_carriage(double carriage_mm);
    /// Where the camera is by whatever tag the next frame shows.
    Result<vision::PositionFit> look_anywhere();
    /// A motion under the supervisor to camera position s, measured by a tag, confirmed at rest.
    Status drive_to(double target_s_mm, int tag_id);

    void saw(const CameraPosition& position) { camera_mm = {position.s_mm, position.y_mm}; }

    const Rig rig;
    const Plate nominal;
    Machine machine;
    Sight sight;
    control::PositionerParams params;
    control::PositionerState state;
    double count_zero_mm = 0.0;  ///< carriage position at count 0, by the registration
    bool registered = false;     ///< against a tag; before that, by the end stop alone
    std::string registered_by;   ///< for people; empty: not at all
    double camera_delay_s = 0.0;
    Eigen::Vector2d camera_mm{0.0, 0.0};
    Setpoints setpoints;

  private:
    /// The positioner's answer to a sample.
    control::StageCommand command_for(const control::StageSample& sample,
                                      const std::optional<control::TargetOffset>& seen);
    /// The positioner's ticks until done(), which is asked before the first one too.
    Status move(const std::predicate auto& done, std::optional<control::TargetOffset> seen = {}) {
        return machine.run(
            [&](const control::StageSample& sample) {
                return command_for(sample, std::exchange(seen, std::nullopt));
            },
            done, setpoints);
    }
    bool carriage_is_quiet() const;
    /// The macro controller's way to a place, until it is there, and to rest with the motor off.
    Status carry(double carriage_mm, double timeout_s, const std::predicate auto& is_there) {
        const double place_mm = std::clamp(carriage_mm, rig.macro.low_mm, rig.macro.high_mm);
        control::macro_go_to(state.macro, (place_mm - count_zero_mm) / params.count_mm);
        setpoints.macro_mm = place_mm;
        auto settled = step_until(is_there, timeout_s, "the macro stage did not settle");
        state.macro.setpoint_count.reset();
        setpoints.macro_mm = not_in_force;
        if (!settled) return settled;
        return step_until([&] { return carriage_is_quiet(); }, params.macro_timeout_s,
                          "the macro stage did not come to rest");
    }
    Result<std::optional<control::TargetOffset>> watch(double target_s_mm, int tag_id,
                                                       std::optional<Failure>& trouble);

    bool wants_frames_ = false;
};

}  // namespace fidservo
