// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A decoded frame's samples as grey.
#include "core/result.h"
#include "vision/images/image_file.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>
}

namespace fidservo::vision {

/// Whether the pixel format has 16-bit samples, and it is not stated how many of the bits are in use.
/// @param stated_bits  as the stream states them; 0: it does not
bool has_open_range_of(const AVPixFmtDescriptor& kind, int stated_bits);

/// The luma of a frame, which for RGB is computed by ITU-R BT.601. Limited-range video levels (black 16 and
/// white 235 of 255) are expanded to 0 and 255. Fails for other pixels (Bayer patterns, floating point, those
/// in hardware surfaces).
Result<StoredImage> grey_samples(const AVFrame& frame, int stated_bits);

}  // namespace fidservo::vision
