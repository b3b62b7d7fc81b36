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

/// Whether samples of such pixels have 16 bits of which no one says how many are used.
/// @param stated_bits  as the stream states them; 0: it does not
bool has_open_range_of(const AVPixFmtDescriptor& kind, int stated_bits);

/// The luma of a frame; of red, green and blue their luma (ITU-R BT.601). Where black and white are those of
/// television (16 and 235 of 255), they become 0 and 255, as ITU-R BT.601 has them.
/// Fails for pixels that are neither (Bayer's patterns, floating point, those that only hardware holds).
Result<StoredImage> grey_samples(const AVFrame& frame, int stated_bits);

}  // namespace fidservo::vision
