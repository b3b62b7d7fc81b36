// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>

namespace fidservo::vision {

/// Where a video's file has to end.
struct StatedEnd {
    std::uint64_t bytes = 0;  ///< its length; 0: nothing states it
    bool lacks_mark = false;  ///< a stream in it has no last page
};

/// By the container's own lengths: Matroska, AVI, MP4 and its kin, Ogg; of other files nothing is known.
StatedEnd stated_end(const char* file);

}  // namespace fidservo::vision
