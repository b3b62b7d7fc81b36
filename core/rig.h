// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a rig is: the numbers of a rig file (assets/rig.yaml), checked, in memory. Parts that a rig does not
// have are empty. docs/notation.md states the equations that the numbers enter.
#include "core/camera/camera_parameters.h"
#include "core/fiducial_parameters.h"
#include "core/formula_effect.h"
#include "core/macro_parameters.h"
#include "core/micro_parameters.h"

#include <optional>
#include <string>
#include <vector>

namespace fidservo {

/// An effect beyond the model that the rig is known to have, by its name in the simulator's catalogue.
struct StatedEffect {
    /// One number of the effect.
    struct Parameter {
        std::string name;  ///< as the simulator's catalogue calls it
        double value;      ///< in the parameter's unit
    };
    std::string name;                   ///< as the simulator's catalogue calls it
    std::vector<Parameter> parameters;  ///< those that the file states
    /// The formula, of an effect that is not in the simulator's catalogue.
    std::optional<FormulaEffect> formula = {};
    std::string stated_at = {};  ///< "FILE:LINE: KEY" where a file states it; for messages
};

/// A rig as its file describes it.
struct Rig {
    std::string name;                             ///< of the rig
    double tick_s;                                ///< period of the control loop
    MacroParameters macro;                        ///< the carriage and its drive
    std::optional<MicroParameters> micro;         ///< the platform, its wire and its sensor
    std::optional<CameraParameters> camera;       ///< the camera over the plate
    std::optional<FiducialParameters> fiducials;  ///< the grid of tags on the plate
    std::vector<StatedEffect> effects;  ///< simulated with the rig; the controllers know nothing of them
};

}  // namespace fidservo
