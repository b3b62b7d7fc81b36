// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Alternative explanations for the views of a calibration: another lens model, tags of another size at the
// same distances, a grid with another number of columns, one view left out. Each is tried by a calibration of
// its own with the same corners.
#include "calib/camera/camera_calibration.h"
#include "core/plate.h"

#include <optional>
#include <vector>

namespace fidservo::calib {

LensModel other_model(LensModel model);

/// Whether `other` explains the corners significantly better than `asked`, both being calibrations of the
/// same views: over the corners that both use, its chi^2 is lower by more than additional lens parameters
/// would lower it by chance in one of a thousand cases if the model of `asked` were true.
bool explains_better(const CameraCalibration& other, const CameraCalibration& asked);

/// Adds to the lens's covariance the possibility that the other lens model is right. If that model explains
/// the corners nearly as well, the parameters that both models have (focal length, principal point, ratio)
/// may have its values. With d the difference of these parameters between the models and w the other model's
/// probability, from the odds exp((chi^2 of the lens - chi^2 of the other) / 2), w d d^T is added to the
/// covariance. Source: Buckland, Burnham, Augustin, Model selection: an integral part of inference,
/// Biometrics 53(2), 1997.
void count_other_model(CameraCalibration& calibration);

/// The calibration of the same views with a given lens model. Empty: there is no solution.
std::optional<CameraCalibration> with_model(const CameraCalibration& asked, LensModel model);

/// The calibration with a given lens model and the size of the tags fitted, too: `tag_scale` is the fitted
/// size relative to the stated one.
std::optional<CameraCalibration> with_free_tag_scale(const CameraCalibration& asked, LensModel model);

/// The calibration with the tags' size fitted as well, but kept near the stated size.
std::optional<CameraCalibration> with_tag_scale_near(const CameraCalibration& asked, LensModel model);

/// The number of columns of a grid whose ids count along its rows; empty: the target is no such grid.
std::optional<int> columns_of(const std::vector<PlateTag>& target);

struct OtherGrid {
    int columns;
    CameraCalibration calibration;
};

/// The calibration with the number of columns, from 1 to 40, that explains the views best.
std::optional<OtherGrid> with_other_columns(const CameraCalibration& asked,
                                            const std::vector<PlateTag>& target, LensModel model);

struct WithoutView {
    std::string name;
    CameraCalibration calibration;
};

/// The calibration without the view whose corners are explained worst. Empty if at most two views would
/// remain.
std::optional<WithoutView> without_worst_view(const CameraCalibration& asked, LensModel model);

}  // namespace fidservo::calib
