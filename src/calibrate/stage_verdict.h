// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether a calibration keeps on fresh moves what its standard errors promise, and whether a rig still is
// what its file says.
#include "calib/drift.h"
#include "src/calibrate/stage_numbers.h"

#include <span>
#include <string>
#include <vector>

namespace fidservo {

/// Errors of one kind at stands that were not fitted.
struct FreshTest {
    std::string what;
    std::string unit;
    std::size_t errors;
    double rms, promised_rms;
    double worst, allowed_worst;
    bool passed;
};

/// The fresh stands against the numbers: the tags' corners in the image, the platform by its Hall sensor
/// against the camera, the carriage by its encoder against the camera. Each test fails a good calibration
/// with a probability of at most about 1 %. The encoder promises half a count, not where in it.
std::vector<FreshTest> test_fresh(const StageNumbers& numbers, std::span<const StageShot> shots);

/// What the rig file says against what was measured, quantity by quantity. Differences that do not matter are
/// smaller than: 1e-4 of the camera's scale, 0.2 mrad of its rotation, 2 mrad of tilt, 0.02 of k1, 0.2 mrad
/// of the stage's axis in the plate and 0.05 mrad towards it (1 um of focus in 20 mm), 2e-4 of the encoder's
/// scale, 2e-3 of the Hall sensor's gain, 4 mV, 10 um and 0.01 of the rest of its curve.
std::vector<calib::Expectation> expectations(const Rig& rig, const StageNumbers& numbers);

}  // namespace fidservo
