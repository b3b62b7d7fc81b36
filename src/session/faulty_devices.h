// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Devices with deliberate faults: decorators of the interfaces to stage and camera, of which neither side
// knows.
#include "control/stage.h"
#include "core/result.h"
#include "src/session/faults.h"
#include "vision/camera.h"

#include <deque>
#include <memory>
#include <optional>
#include <vector>

namespace fidservo {

class FaultyStage final : public control::Stage {
  public:
    FaultyStage(std::shared_ptr<control::Stage> stage, std::vector<Fault> faults)
        : stage_(std::move(stage)), faults_(std::move(faults)) {}

    Result<control::StageSample> read() override;
    Status write(const control::StageCommand& command) override;

  private:
    bool is_on(FaultKind kind) const;

    std::shared_ptr<control::Stage> stage_;
    std::vector<Fault> faults_;
    TimeNs now_ns_ = 0;  ///< time of the decorated stage
    std::optional<int> stuck_adc_;
};

class FaultyCamera final : public vision::Camera {
  public:
    FaultyCamera(std::shared_ptr<vision::Camera> camera, std::vector<Fault> faults)
        : camera_(std::move(camera)), faults_(std::move(faults)) {}

    Result<std::optional<vision::Frame>> poll(TimeNs now_ns) override;
    vision::FrameCounts counts() const override;

  private:
    struct Late {
        TimeNs due_ns;
        vision::Frame frame;
    };

    bool is_on(FaultKind kind, TimeNs now_ns) const;
    std::optional<vision::Frame> spoilt(vision::Frame frame, TimeNs now_ns);
    std::optional<vision::Frame> newest_due(TimeNs now_ns);

    std::shared_ptr<vision::Camera> camera_;
    std::vector<Fault> faults_;
    std::deque<Late> late_;
    cv::Mat frozen_;
    std::uint64_t lost_ = 0, handed_out_ = 0;
};

}  // namespace fidservo
