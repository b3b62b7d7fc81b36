// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Comparison of a view with a reference image.
#include "src/inspect/measure/checks.h"

namespace fidservo::inspect {

/// A row for each defect: its value is the defect's length (of the smallest rectangle around it), the nominal
/// value 0, the tolerance the largest allowed length. If there is no defect, one row that passes. The
/// length's uncertainty is that of its two ends, each known to within half a pixel: u = 1 px / sqrt(6).
CheckedView compare_view(const CheckContext& context, const ReferenceCheck& check);

/// An image of a good part as a reference: its place comes from the fiducial in it. Throws InputError if it
/// cannot be read, is not of the camera's size, or does not show the fiducial.
vision::ReferenceImage load_reference(const std::filesystem::path& file, const CameraParameters& camera,
                                      const Plate& nominal, int tag_id);

}  // namespace fidservo::inspect
