// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What else would explain the views of a calibration: another lens model, tags of another size beside their
// distances, a grid of another number of columns, all views but one. Each is tried, by a calibration of its
// own on the same corners.
#include "calib/camera/camera_calibration.h"
#include "core/plate.h"

#include <optional>
#include <vector>

namespace fidservo::calib {

LensModel other_model(LensModel model);

/// The corners that both explain, by which of two calibrations of the same views explains them better.
/// Whether `other` does so beyond chance: were the model of `asked` true, all numbers of a lens together
/// could gain more than this in one case of a thousand.
bool explains_better(const CameraCalibration& other, const CameraCalibration& asked);

/// Counts in the standard errors of the lens that it may be one of the other model: where that explains the
/// corners nearly as well, what lenses of both models have (focal length, principal point, ratio) may be as
/// it has them. With d the way to its numbers and w its weight by the data, odds exp((chi^2 of the lens -
/// chi^2 of the other) / 2), the covariance grows by w d d^T. Source: Buckland, Burnham, Augustin, Model
/// selection: an integral part of inference, Biometrics 53(2), 1997.
void count_other_model(CameraCalibration& calibration);

/// The views of a calibration as they were seen, with the model given. Empty: there is no solution.
std::optional<CameraCalibration> with_model(const CameraCalibration& asked, LensModel model);

/// The same with the tags' size free: `tag_scale` is the share of what is said of them.
std::optional<CameraCalibration> with_free_tag_scale(const CameraCalibration& asked, LensModel model);

/// The same where the tags are nearly as large as said.
std::optional<CameraCalibration> with_tag_scale_near(const CameraCalibration& asked, LensModel model);

/// The number of columns of a grid whose ids count along its rows; empty: the target is no such grid.
std::optional<int> columns_of(const std::vector<PlateTag>& target);

struct OtherGrid {
    int columns;
    CameraCalibration calibration;
};

/// With the number of columns, of 1 to 40, that explains the views best.
std::optional<OtherGrid> with_other_columns(const CameraCalibration& asked,
                                            const std::vector<PlateTag>& target, LensModel model);

struct WithoutView {
    std::string name;
    CameraCalibration calibration;
};

/// Without the view whose corners are explained worst. Empty where two views would remain at most.
std::optional<WithoutView> without_worst_view(const CameraCalibration& asked, LensModel model);

}  // namespace fidservo::calib
