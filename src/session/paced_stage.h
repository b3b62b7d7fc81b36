#pragma once
#include "control/stage.h"

#include <memory>
#include <optional>

namespace fidservo {

/// A stage of virtual time in real time: its ticks come when they are due by CLOCK_MONOTONIC, and are stamped
/// with that clock. So a simulated stage goes with a real camera. Ticks that are late are made up for.
class PacedStage final : public control::Stage {
  public:
    explicit PacedStage(std::shared_ptr<control::Stage> stage) : stage_(std::move(stage)) {}

    Result<control::StageSample> read() override;
    Status write(const control::StageCommand& command) override { return stage_->write(command); }

  private:
    std::shared_ptr<control::Stage> stage_;
    std::optional<TimeNs> start_ns_;  ///< of the virtual time, on the real clock
};

}  // namespace fidservo
