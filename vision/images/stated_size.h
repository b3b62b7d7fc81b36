// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the headers of files say that OpenCV's codecs decode. It is checked beforehand, as the codecs return
// partial images for some truncated formats, and allocate whatever memory a header claims.
#include "core/result.h"

#include <cstddef>
#include <span>

namespace fidservo::vision {

struct StatedSize {
    bool is_deep = false;  ///< samples may have more than 8 bits
    int bits = 0;  ///< of deeper samples: how many bits the header states to be in use; 0: it does not
};

/// Of BMP, WebP, JPEG 2000 and Sun raster, from the whole file: fails with Reason::device if it
/// is shorter than its header says, or if that claims a side beyond most_side_px. Other formats are not
/// checked, but floating-point ones (Radiance, PFM, OpenEXR), whose samples have no defined white, fail.
Result<StatedSize> stated_size(std::span<const std::byte> file);

/// Whether the samples may have more than 8 bits, by the beginning of a file of one of those formats.
bool is_deep_beginning(std::span<const std::byte> beginning);

}  // namespace fidservo::vision
