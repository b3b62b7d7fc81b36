// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What a survey's stands say: the camera-to-stage map, the Hall sensor's curve against the camera, the length
// of an encoder count.
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

/// A stand, as the numbers explain it.
struct StandResidual {
    StageMove move;
    double s_mm;           ///< by the camera
    double platform_mm;    ///< by the fitted Hall curve
    double hall_error_mm;  ///< platform by Hall minus by camera; NaN where the carriage moved meanwhile
    double count_error;    ///< place by encoder minus by camera and Hall, counts; NaN where it was not used
};

struct StageNumbers {
    calib::StageMap map;
    std::vector<const StageShot*> mapped;  ///< the shots that the map's views are, in its order
    calib::HallCurve hall;
    double hall_scale;  ///< plate mm per mm by the rig file's Hall curve, over the travel
    double hall_scale_std;
    double platform_error_mm;  ///< standard deviation of a place by the fitted Hall curve
    calib::EncoderScale encoder;
    double extended_s_mm;   ///< camera position with the platform relaxed
    double extended_count;  ///< the carriage's count meanwhile
    std::vector<StandResidual> residuals;
};

/// From all stands that are not fresh. Where the shots have their images, tags are refined again with the
/// camera that a first map found, until a last map is fitted to tags whose bent edges are known. Fails with
/// Reason::not_identifiable if they do not determine a number.
Result<StageNumbers> stage_numbers(const Rig& rig, std::vector<StageShot>& shots);

/// A stand against the numbers, wherever the camera saw it.
StandResidual residual_of(const StageNumbers& numbers, const StageShot& shot, double s_mm);

bool is_fresh(const StageShot& shot);

}  // namespace fidservo
