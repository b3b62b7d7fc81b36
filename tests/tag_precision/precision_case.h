// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The cases on which a refinement is tested: pictures, the prior knowledge given to it, and the required
// accuracy.
#include "tests/tag_precision/sensor.h"
#include "tests/tag_precision/tag_scene.h"
#include "vision/tags/tag_refinement.h"

#include <string>
#include <vector>

namespace fidservo::precision {

struct PrecisionLimits {
    double sigma_ratio;  ///< standard deviation over the Cramer-Rao bound
    double bias_px;
    /// Amplitude of the error's periodic part as a function of the place between pixels.
    double first_harmonic_px;
};

/// One kind of picture.
struct PrecisionCase {
    std::string name;
    TagScene scene;
    Sensor sensor;
    vision::RefinementOptions known;  ///< prior knowledge given to the refinement
    PrecisionLimits limits;
    Eigen::Matrix2d bound_px2() const;  ///< for the visible part; with unknown tilt if the camera is unknown
};

/// A tag of 320 px in 640 x 480, turned by 0.7 degrees, edges of 0.8 px, grey levels 33 and 194 of 255, seen
/// by a known camera with 10,000 electrons full well and 5 electrons of read noise, is `sharp`. The others
/// differ from it in what their name says.
std::vector<PrecisionCase> precision_cases();

}  // namespace fidservo::precision
