// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/plate.h"

namespace fidservo {

/// The reference rig's fiducials, without reading its file.
inline Plate row_of_tags() {
    Plate plate;
    for (int k = 0; k < 100; ++k) plate.tags.push_back({k, {2.0 * k, 0.0}, 1.2});
    return plate;
}

}  // namespace fidservo
