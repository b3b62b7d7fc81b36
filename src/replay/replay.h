// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/camera/camera_parameters.h"
#include "src/images/image_frames.h"
#include "src/images/image_tally.h"
#include "src/replay/unread_tags.h"
#include "vision/tags/tag_book.h"

#include <cstddef>
#include <filesystem>
#include <optional>

namespace fidservo {

struct ReplayCount {
    ImageTally images;
    std::size_t tags = 0;
    FrameSample sample;  ///< sample of the frames that were searched
};

/// Finds the tags of all frames on `threads` cores, and writes detections.csv and displacements.csv into a
/// folder that exists, in the frames' order. One timed series gives files with times, as in a recording;
/// anything else has the image's name in the first column instead. Displacements are those of
/// vision/displacement.h, counted from each series' own first frames. A frame that cannot be read is left
/// out; the count names it. Throws RunFault if the disk fails.
/// @param camera  that took the frames of its size, if it is known
/// @param reading  as which tags are looked for
ReplayCount replay(ImageFrames& frames, double tag_side_mm, const std::filesystem::path& folder,
                   unsigned threads, const std::optional<CameraParameters>& camera = {},
                   const vision::TagReading& reading = {});

}  // namespace fidservo
