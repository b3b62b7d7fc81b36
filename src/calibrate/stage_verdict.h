// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Whether fresh moves agree with a calibration within its standard errors, and whether a rig still agrees
// with its file.
#include "calib/drift.h"
#include "src/calibrate/stage_numbers.h"

#include <span>
#include <string>
#include <vector>

namespace fidservo {

/// The errors of one kind at stands that were not used in the fit.
struct FreshTest {
    std::string what;
    std::string unit;
    std::size_t errors;
    double rms, promised_rms;
    double worst, allowed_worst;
    bool passed;
};

/// Tests the results on the fresh stands: the tags' corners in the image, the platform by its Hall sensor
/// against the camera, the carriage by its encoder against the camera. Each test fails a good calibration
/// with a probability of at most about 1 %. For the encoder the error may be up to half a count.
std::vector<FreshTest> test_fresh(const StageNumbers& numbers, std::span<const StageShot> shots);

/// The rig file's values against the measured ones, quantity by quantity. Differences count as irrelevant
/// below: 1e-4 of the camera's scale, 0.2 mrad of its rotation, 2 mrad of tilt, 0.02 of k1, 0.2 mrad of the
/// stage's axis in the plate and 0.05 mrad towards it (1 um of focus in 20 mm), 2e-4 of the encoder's scale,
/// 2e-3 of the Hall sensor's gain, 4 mV, 10 um and 0.01 of the rest of its curve.
std::vector<calib::Expectation> expectations(const Rig& rig, const StageNumbers& numbers);

}  // namespace fidservo
