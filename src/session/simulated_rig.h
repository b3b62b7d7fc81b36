// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The simulated rig: one physical state behind a stage and a camera, in virtual time. Time advances by a tick
// when a command is written; frames are rendered only when requested.
#include "control/guardian.h"
#include "control/stage.h"
#include "core/camera/camera_parameters.h"
#include "core/plate.h"
#include "core/result.h"
#include "plant/stage_plant.h"
#include "plant/view/plate_view.h"
#include "vision/camera.h"

#include <array>
#include <memory>
#include <string>

namespace fidservo {

/// One physical state in virtual time, for a stage and a camera.
class SimulatedRig {
  public:
    /// @param physics  the true rig, which may differ from its file
    /// @param printed  the plate as printed
    SimulatedRig(const plant::PlantParameters& physics, const CameraParameters& camera, const Plate& printed,
                 std::uint64_t seed);

    /// Samples the sensors.
    control::StageSample read();
    /// Applies a command for a tick, and advances by that tick.
    void write(const control::StageCommand& command);
    /// The newest frame that has arrived and was not returned before.
    std::optional<vision::Frame> poll();

    /// Time since the start.
    TimeNs now_ns() const { return tick_ * tick_ns_; }
    /// The true state: for tests and for drawing, never for what runs on the rig.
    const plant::StageState& truth() const { return state_; }
    /// The true rig, which may differ from its file.
    const plant::StagePlant& physics() const { return plant_; }

    /// The whole physical state as JSON text, exact.
    std::string snapshot() const;
    /// Continues from a snapshot. Throws InputError if the text is none.
    void restore(const std::string& snapshot);

  private:
    double position_mm(double time_s) const;

    plant::StagePlant plant_;
    CameraParameters camera_;
    plant::PlateView view_;
    plant::StageState state_;
    TimeNs tick_ns_;
    std::int64_t tick_ = 0;
    std::int64_t next_frame_ = 0;
    std::array<double, 1024> past_mm_;  ///< camera position at the last ticks, by tick modulo its size
};

/// The rig's stage side. Every command also goes to the guardian's board, where there is a guardian.
class SimulatedStage final : public control::Stage {
  public:
    /// @param guardian  null: commands go to the rig only
    SimulatedStage(std::shared_ptr<SimulatedRig> rig, std::shared_ptr<control::Guardian> guardian)
        : rig_(std::move(rig)), guardian_(std::move(guardian)) {}
    Result<control::StageSample> read() override;
    Status write(const control::StageCommand& command) override;

  private:
    std::shared_ptr<SimulatedRig> rig_;
    std::shared_ptr<control::Guardian> guardian_;
};

/// The rig's camera side.
class SimulatedCamera final : public vision::Camera {
  public:
    /// Sees the rig in its state at each poll.
    explicit SimulatedCamera(std::shared_ptr<SimulatedRig> rig) : rig_(std::move(rig)) {}
    Result<std::optional<vision::Frame>> poll(TimeNs now_ns) override;

  private:
    std::shared_ptr<SimulatedRig> rig_;
};

}  // namespace fidservo
