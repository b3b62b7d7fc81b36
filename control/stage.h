// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The boundary to a stage: real board, simulated rig or anything else that takes two voltages and gives two
// readings.
#include "core/result.h"
#include "core/time.h"

namespace fidservo::control {

/// What the board samples at a tick.
struct StageSample {
    TimeNs time_ns = 0;              ///< of the sampling, on the program's clock
    std::int64_t encoder_count = 0;  ///< counts since power came on
    int hall_adc = 0;                ///< of the platform's Hall sensor, LSB
};

/// What the board holds until the next tick, V. Zero switches the motor and the heater off.
struct StageCommand {
    double macro_V = 0.0;  ///< of the motor
    double micro_V = 0.0;  ///< of the heater
};

/// A stage that is driven tick by tick: one read, then one write. For one thread.
class Stage {
  public:
    Stage() = default;
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;
    virtual ~Stage() = default;

    /// Waits for the next tick and samples the sensors. Fails with Reason::device or Reason::stopped.
    virtual Result<StageSample> read() = 0;
    /// Applies a command until the next write.
    virtual Status write(const StageCommand& command) = 0;
};

}  // namespace fidservo::control
