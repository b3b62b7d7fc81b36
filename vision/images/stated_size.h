// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the files say of themselves that OpenCV's codecs decode: their codecs hand out what there is of some
// formats that were cut short, and take memory for whatever a header claims.
#include "core/result.h"

#include <cstddef>
#include <span>

namespace fidservo::vision {

struct StatedSize {
    bool is_deep = false;  ///< samples may have more than 8 bits
    int bits = 0;  ///< of samples of more than 8 bits: those that the header says are used; 0: it does not
};

/// Of PNM and PAM, BMP, WebP, JPEG 2000 and Sun raster, from the whole file: fails with Reason::device if it
/// is shorter than its header says, or if that claims a side beyond most_side_px. Nothing is asked of other
/// formats, save that floating-point ones (Radiance, PFM, OpenEXR), whose samples have no white, fail.
Result<StatedSize> stated_size(std::span<const std::byte> file);

/// May the samples have more than 8 bits? From the beginning of a file of those formats.
bool is_deep_beginning(std::span<const std::byte> beginning);

}  // namespace fidservo::vision
