// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The grid of fiducials of a rig file (assets/rig.yaml), checked, in memory.
#include "core/tag_families.h"

namespace fidservo {

/// The grid of fiducials printed on the plate that the rig file describes: tag first_id + column +
/// row * columns is centred at (column pitch_x, row pitch_y).
struct FiducialParameters {
    TagPrint print;  ///< how its tags are printed
    double side_mm;  ///< of a tag's outline
    /// Distance between the centres of neighbouring tags along plate x and along plate y.
    double pitch_x_mm, pitch_y_mm;
    /// How many tags there are along x and along y.
    int columns, rows;
    int first_id;  ///< id of the tag at plate x 0, y 0
};

}  // namespace fidservo
