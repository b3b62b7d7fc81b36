// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The results of a survey: the camera-to-stage map, the Hall sensor's curve against the camera, and the
// encoder's resolution.
#include "calib/hall/hall_curve.h"
#include "calib/macro/encoder_scale.h"
#include "calib/stage/stage_map.h"
#include "core/result.h"
#include "src/calibrate/stage_survey.h"

#include <optional>
#include <span>
#include <vector>

namespace fidservo {

struct Rig;

/// The residuals of one stand under the results.
struct StandResidual {
    StageMove move;
    double s_mm;         ///< camera position by the camera
    double platform_mm;  ///< platform position by the fitted Hall curve
    /// Platform position by Hall sensor minus by camera; NaN where the carriage moved meanwhile.
    double hall_error_mm;
    /// Carriage position by encoder minus by camera and Hall sensor, counts; NaN where it was not used.
    double count_error;
};

struct StageNumbers {
    calib::StageMap map;
    std::vector<const StageShot*> mapped;  ///< the shots of the map's views, in its order
    calib::HallCurve hall;
    double hall_scale;  ///< slope of the rig file's Hall curve against the camera over the travel
    double hall_scale_std;
    double platform_error_mm;  ///< standard deviation of a platform position by the fitted Hall curve
    calib::EncoderScale encoder;
    double extended_s_mm;   ///< camera position with the platform relaxed
    double extended_count;  ///< the encoder's count meanwhile
    std::vector<StandResidual> residuals;
};

/// Computes the results from all stands but the fresh ones. Where shots include images, their tags are
/// refined again with the camera of a first map, so that the last map is fitted to tags whose distorted edges
/// are modelled. Fails with Reason::not_identifiable if the stands do not determine a number.
Result<StageNumbers> stage_numbers(const Rig& rig, std::vector<StageShot>& shots);

/// The residuals of a stand for a given camera position.
StandResidual residual_of(const StageNumbers& numbers, const StageShot& shot, double s_mm);

bool is_fresh(const StageShot& shot);

}  // namespace fidservo
