// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Divides a large number of images into stretches.
#include "src/images/image_frames.h"

#include <cstddef>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// Largest number of images in a stretch; larger for videos, whose frames can be decoded only in order.
inline constexpr std::size_t images_a_stretch = 1000, pictures_a_stretch = 10'000;

/// A series of consecutive images.
struct Stretch {
    std::size_t series = 0;  ///< index of the series of ImageFrames in which it begins
    std::size_t first = 0;   ///< index of its first frame in that series
    std::size_t count = 0;
    bool is_open = false;  ///< the last stretch of a video, which goes to the video's end
    std::string noted;     ///< its series' path as results note it (noted_path)

    /// file_stem() of what it is of, and the number of its first image.
    std::string stem() const;
};

/// Divides each folder, recording and video separately, and likewise the images that were given by name;
/// consecutive series of a single image are joined first. The stretches depend on the images only, not on the
/// number of processes.
std::vector<Stretch> stretches_of(const std::vector<ImageFrames::Series>& series);

}  // namespace fidservo::fleet
