#pragma once
// The plate of a rig file (assets/rig.yaml), checked, in memory.
#include "core/tag_families.h"

namespace fidservo {

/// The grid of fiducials printed on the plate that the rig file describes: tag first_id + column +
/// row * columns is centred at (column pitch_x, row pitch_y).
struct FiducialParameters {
    TagPrint print;
    double side_mm;
    double pitch_x_mm, pitch_y_mm;
    int columns, rows;
    int first_id;
};

}  // namespace fidservo
