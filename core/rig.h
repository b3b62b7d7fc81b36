#pragma once
// What a rig is: the numbers of a rig file (assets/rig.yaml), checked, in memory. Parts that a rig does not
// have are empty. docs/notation.md states the equations that the numbers enter.
#include "core/camera_parameters.h"
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
    struct Parameter {
        std::string name;
        double value;
    };
    std::string name;
    std::vector<Parameter> parameters;
    std::optional<FormulaEffect> formula = {};  ///< of what the simulator's catalogue does not list
};

struct Rig {
    std::string name;
    double tick_s;
    MacroParameters macro;
    std::optional<MicroParameters> micro;
    std::optional<CameraParameters> camera;
    std::optional<FiducialParameters> fiducials;
    std::vector<StatedEffect> effects;  ///< the simulator has them; controllers know nothing of them
};

}  // namespace fidservo
