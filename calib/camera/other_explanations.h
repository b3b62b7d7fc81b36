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
/// same views: over the corners that both use, it gains more than all numbers of a lens together could gain
/// in one case of a thousand if the model of `asked` were true.
bool explains_better(const CameraCalibration& other, const CameraCalibration& asked);

/// Includes in the standard errors of the lens that the other lens model may be right. Where that model
/// explains the corners nearly as well, the numbers that both models have (focal length, principal point,
/// ratio) may have its values. With d the difference to its numbers and w its probability, from the odds
/// exp((chi^2 of the lens - chi^2 of the other) / 2), the covariance grows by w d d^T. Source: Buckland,
/// Burnham, Augustin, Model selection: an integral part of inference, Biometrics 53(2), 1997.
void count_other_model(CameraCalibration& calibration);

/// The calibration of the same views with a given lens model. Empty: there is no solution.
std::optional<CameraCalibration> with_model(const CameraCalibration& asked, LensModel model);

/// The same with the tags' size fitted as well: `tag_scale` is the fitted size relative to the stated one.
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

/// The calibration without the view whose corners are explained worst. Empty where two views at most would
/// remain.
std::optional<WithoutView> without_worst_view(const CameraCalibration& asked, LensModel model);

}  // namespace fidservo::calib
