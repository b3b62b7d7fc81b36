// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/images/image_frame.h"

#include "core/input_error.h"
#include "vision/images/image_file.h"

#include <fmt/format.h>

namespace fidservo {

bool load(ImageFrame& frame) {
    if (!frame.damage.empty()) return false;
    if (!frame.decoded.empty()) return true;
    const auto stored = vision::read_stored(frame.file, frame.page);
    if (!stored) {
        frame.damage = stored.error().text;
        return false;
    }
    frame.orientation = stored->orientation;
    frame.has_more_pictures = stored->has_more_pictures;
    frame.decoded = vision::to_8_bits(*stored, frame.bits);
    return true;
}

cv::Mat decode(const ImageFrame& frame) {
    ImageFrame loaded = frame;
    if (!load(loaded)) throw InputError(loaded.damage);
    return loaded.decoded;
}

}  // namespace fidservo
