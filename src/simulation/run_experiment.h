// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The control loop for every simulated rig: the published controllers on the sensors' readings, tick by tick.
#include "core/recording.h"
#include "src/simulation/experiments.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fidservo {

struct Rig;

/// The boundary between the loop and the rig that is simulated. In each tick: sample, look, advance.
class SimulatedHardware {
  public:
    struct Reading {
        std::int64_t encoder_count;
        int hall_adc;  ///< 0 without a micro stage
    };

    SimulatedHardware() = default;
    SimulatedHardware(const SimulatedHardware&) = delete;
    SimulatedHardware& operator=(const SimulatedHardware&) = delete;
    virtual ~SimulatedHardware() = default;

    virtual Reading sample() = 0;
    /// Appends the fiducials of the frames whose exposure is centred in the tick that begins at time_ns,
    /// under the commands given. Nothing without a camera.
    virtual void look(TimeNs time_ns, double macro_V, double micro_V,
                      std::vector<TagDetection>& detections) = 0;
    /// One tick under held commands in V.
    virtual void advance(double macro_V, double micro_V) = 0;
};

/// The encoder's zero of a simulated rig, which counts as homed.
EncoderZero simulated_zero();

/// Runs an experiment and records it as the real rig's would be recorded.
/// @param name  of the recording
Recording run_experiment(const Rig& rig, const Experiment& experiment, const std::string& name,
                         SimulatedHardware& hardware);

/// The seed of all noise in a recording.
std::uint64_t noise_seed(const std::string& name, std::uint64_t seed);

}  // namespace fidservo
