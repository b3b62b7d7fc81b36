// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Very many images, cut into stretches.
#include "src/images/image_frames.h"

#include <cstddef>
#include <string>
#include <vector>

namespace fidservo::fleet {

/// How long a stretch is at most; of a video longer, as its pictures can only be had with those before them.
inline constexpr std::size_t images_a_stretch = 1000, pictures_a_stretch = 10'000;

/// Images in a row.
struct Stretch {
    std::size_t series = 0;  ///< of ImageFrames, in which it begins
    std::size_t first = 0;   ///< of that series' frames
    std::size_t count = 0;
    bool is_open = false;  ///< the last of a video, to its end, wherever that is
    std::string noted;     ///< the path of its series (noted_path)

    /// file_stem() of what it is of, and the number of its first image.
    std::string stem() const;
};

/// Cuts each folder, recording, stack or video by itself; single images that were given one after the other
/// are taken together. That depends on nothing else: the same images give the same stretches.
std::vector<Stretch> stretches_of(const std::vector<ImageFrames::Series>& series);

}  // namespace fidservo::fleet
