// SPDX-License-Identifier: GPL-3.0-or-later
// The module's door: the only place that sees OpenCV's image codecs, libtiff and FFmpeg's libraries.
#include "core/failure.h"
#include "vision/images/media.h"
#include "vision/images/module/parts.h"

#include <opencv2/imgcodecs.hpp>

namespace fidservo::vision {
namespace {

bool is_image(const char* file) {
    try {
        return cv::haveImageReader(file);
    } catch (const cv::Exception&) {
        return false;
    }
}

Result<cv::Mat> read_image(const char* file) {
    constexpr int as_stored = cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION;
    cv::Mat grey;
    try {
        grey = cv::imread(file, as_stored);
    } catch (const cv::Exception&) {
        return failure(Reason::device, "its header is damaged");
    }
    if (grey.empty())
        return failure(Reason::device,
                       is_image(file) ? "it is damaged" : "it is of no format of images that is read");
    if (grey.type() != CV_8UC1 && grey.type() != CV_16UC1)
        return failure(Reason::device,
                       "its samples are not whole numbers of 8 or 16 bits: save it with those");
    return grey;
}

}  // namespace
}  // namespace fidservo::vision

extern "C" {
extern const fidservo::vision::MediaModule fidservo_media_module;
const fidservo::vision::MediaModule fidservo_media_module{
    &fidservo::vision::is_image, &fidservo::vision::read_image, &fidservo::vision::tiff_pages,
    &fidservo::vision::tiff_page, &fidservo::vision::ffmpeg_video};
}
