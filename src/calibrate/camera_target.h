// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The target of a camera's calibration.
#include "core/fiducial_parameters.h"
#include "core/plate.h"

#include <filesystem>
#include <string>
#include <vector>

namespace fidservo {

struct CameraTarget {
    std::vector<PlateTag> tags;
    std::string text;    ///< description for messages
    bool is_rigs_plate;  ///< the target is the plate of a rig file
    TagPrint print() const { return tags.front().print; }
};

/// A kalibr AprilGrid: tag36h11 with a border of two cells, tag `row * columns + column`, row 0 at the
/// bottom.
/// @param spacing  gap between tags over their side
CameraTarget april_grid(int columns, int rows, double tag_size_mm, double spacing);

/// The same by a text like "6x6", columns x rows. Throws InputError.
CameraTarget april_grid(const std::string& grid, double tag_size_mm, double spacing);

/// A target file as kalibr writes them: target_type aprilgrid, tagCols, tagRows, tagSize in m, tagSpacing.
/// Throws InputError.
CameraTarget load_kalibr_target(const std::filesystem::path& file);

/// The plate of a rig.
CameraTarget plate_target(const FiducialParameters& fiducials);

}  // namespace fidservo
