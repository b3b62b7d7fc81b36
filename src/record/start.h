// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The initial state of experiments: the carriage at a place, the wire cold, everything at rest.
#include "core/result.h"
#include "core/time.h"
#include "src/session/pilot.h"

#include <string>

namespace fidservo {

/// How long the wire is left without heat, s: several of its cooling time constants.
double cooling_s(const Rig& rig);

/// Brings a homed rig to the starts of experiments, one after the other.
class ExperimentStart {
  public:
    /// Switches the heater off.
    explicit ExperimentStart(Pilot& pilot) : pilot_(pilot) {
        pilot_.begin_anew();
        heater_was_on();
    }

    /// The carriage goes there while the wire cools; it has cooled when the heater has been off for
    /// cooling_s() and the Hall reading is steady. A reading that drifts on is waited for for a while, and
    /// then noted.
    /// @return what is worth noting; empty: nothing
    Result<std::string> bring_to(double carriage_mm);

    /// States that the heater may have been on until now.
    void heater_was_on();

  private:
    Result<std::string> cool();

    Pilot& pilot_;
    TimeNs heater_off_ns_ = 0;
    bool cold_ = false;  ///< the wire was found cold since the heater was last on
};

}  // namespace fidservo
