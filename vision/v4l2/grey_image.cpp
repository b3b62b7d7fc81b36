// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/grey_image.h"

#include "core/demand.h"

#include <opencv2/core.hpp>

namespace fidservo::vision::v4l2 {

namespace {

cv::Mat view_of(const CaptureFormat& format, int type, std::span<const std::byte> bytes) {
    FIDSERVO_DEMAND(is_whole(format, bytes.size()));
    auto* data = const_cast<std::byte*>(bytes.data());  // cv::Mat has no view on constant data
    return {format.height_px, format.width_px, type, data, format.bytes_per_line};
}

/// From `bits` bit in 16 to 8, full scale to full scale.
cv::Mat scaled(const cv::Mat& deep, int bits) {
    cv::Mat grey;
    deep.convertTo(grey, CV_8U, 255.0 / ((1 << bits) - 1));
    return grey;
}

}  // namespace

bool is_whole(const CaptureFormat& format, std::size_t used) {
    const auto pixel = bytes_per_pixel(format.pixels);
    if (!pixel) return used > 0;
    return used >= format.bytes_per_line * static_cast<std::size_t>(format.height_px - 1) +
                       static_cast<std::size_t>(format.width_px) * static_cast<std::size_t>(*pixel);
}

Result<cv::Mat> grey_image(const CaptureFormat& format, std::span<const std::byte> bytes, JpegDecoder& jpeg) {
    switch (format.pixels) {
        case PixelFormat::grey:
            return view_of(format, CV_8UC1, bytes);
        case PixelFormat::y16:
            return scaled(view_of(format, CV_16UC1, bytes), 16);
        case PixelFormat::y12:
            return scaled(view_of(format, CV_16UC1, bytes), 12);
        case PixelFormat::y10:
            return scaled(view_of(format, CV_16UC1, bytes), 10);
        case PixelFormat::yuyv: {
            cv::Mat luma;
            cv::extractChannel(view_of(format, CV_8UC2, bytes), luma, 0);
            return luma;
        }
        case PixelFormat::mjpeg:
            break;
    }
    return jpeg.decode(bytes);
}

}  // namespace fidservo::vision::v4l2
