// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The rig in operation: machine, sight and positioner, and the registration of the camera's position.
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

/// Offsets along the stage axis, mm, at which the camera looks for a fiducial that it does not find where it
/// should be.
inline constexpr std::array search_offsets_mm{0.0, 0.7, -0.7};

inline tl::unexpected<Failure> forward(Failure why) {
    return tl::make_unexpected(std::move(why));
}

class Pilot {
  public:
    /// The rig must have all parts from which `params` were made (motion_params.h).
    /// @param camera_reconnect_s  how long to wait for a camera that is lost
    Pilot(const Rig& rig, const Plate& nominal, const control::PositionerParams& params, Devices devices,
          double camera_reconnect_s = 0.0);

    /// The camera's position by the registration, plate x, mm.
    double believed_s_mm() const;
    /// Corrects the registration by a position that a frame has just shown. A large correction is logged:
    /// counts were lost, or the carriage was pushed.
    /// @param tag_id  of the tag that was seen
    void register_at(double s_mm, int tag_id);
    /// Registers the position of the end stop, which is accurate to a count.
    void register_at_end_stop(std::int64_t stop_count);

    /// The encoder's zero, by the registration; empty before a tag has shown it: a carriage that is held
    /// anywhere looks like one at its end stop.
    std::optional<EncoderZero> encoder_zero() const;

    /// The carriage's position by the registration, mm.
    double carriage_mm() const;
    /// The carriage's travel in encoder counts, by the registration.
    control::CarriageTravel carriage_travel() const;

    /// One tick of the positioner.
    Status step();
    /// Passes ticks without a controller to the positioner, before a motion begins. Nothing in virtual time.
    Status catch_up();

    /// Ticks until a condition holds. Fails with Reason::timeout.
    Status step_until(const std::predicate auto& condition, double timeout_s, const char* what) {
        const long most = std::lround(timeout_s / rig.tick_s);
        long ticks = 0;
        auto ended = move([&] { return condition() || ticks++ > most; });
        if (ended && !condition()) return failure(Reason::timeout, what);
        return ended;
    }

    /// Resets the positioner to the present state after other motions: the motor is off, the wire without
    /// heat.
    void begin_anew();

    /// The next frame exposed wholly after a time, in true exposure time. Fails with Reason::timeout.
    Result<vision::Frame> next_frame(TimeNs after_ns);
    /// A frame's true middle of exposure: its time stamp less the delay that the tuning sweep found.
    TimeNs exposed_at(const vision::Frame& frame) const;

    /// Brings the macro stage so that the camera stands at s, by the registration alone; nothing is
    /// confirmed.
    Status carry_to(double s_mm);
    /// Brings the carriage to its place `carriage_mm`, by the registration, and to rest within a count of it.
    /// Where late commands or readings make the controller oscillate, to within a few counts.
    Status place_carriage(double carriage_mm);
    /// Keeps what was located in a frame: for the recording, if there is one, and the live page.
    Status keep_sight(const vision::Frame& frame);
    /// The camera's position from any tag in the next frame.
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
    bool registered = false;     ///< registered against a tag; before that, only by the end stop
    std::string registered_by;   ///< how it was registered, in words; empty: not at all
    double camera_delay_s = 0.0;
    Eigen::Vector2d camera_mm{0.0, 0.0};
    Setpoints setpoints;

  private:
    /// The positioner's command for a sample.
    control::StageCommand command_for(const control::StageSample& sample,
                                      const std::optional<control::TargetOffset>& seen);
    /// Ticks the positioner until done(), which is checked before the first tick, too.
    Status move(const std::predicate auto& done, std::optional<control::TargetOffset> seen = {}) {
        return machine.run(
            [&](const control::StageSample& sample) {
                return command_for(sample, std::exchange(seen, std::nullopt));
            },
            done, setpoints);
    }
    bool carriage_is_quiet() const;
    /// Moves the macro stage to a place, until it is there and at rest with the motor off.
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
