// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Divides a large number of images into stretches.
#include "src/images/image_frames.h"

#include <cstddef>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// Largest number of images in a stretch; for videos it is larger, as frames can only be decoded after those
/// before them.
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

/// Cuts each folder, recording or video, and the images that were given by name, by itself; series of a
/// single image that follow one another are taken together. That depends on nothing else: the same images
/// give the same stretches.
std::vector<Stretch> stretches_of(const std::vector<ImageFrames::Series>& series);

}  // namespace fidservo::fleet
