// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/vm/loopback_feed.h"

#include <stdexcept>
#include <string>

#include <linux/videodev2.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <unistd.h>

namespace fidservo::devices {

namespace {

using vision::v4l2::Device;
using vision::v4l2::PixelFormat;

Device open_or_throw(const std::filesystem::path& node) {
    auto device = Device::open(node);
    if (!device) throw std::runtime_error(device.error().text);
    return *std::move(device);
}

std::vector<std::uint8_t> bytes_of(const cv::Mat& image) {
    return {image.datastart, image.dataend};
}

}  // namespace

std::vector<std::uint8_t> encoded(const cv::Mat& grey, PixelFormat pixels) {
    cv::Mat image;
    std::vector<std::uint8_t> jpeg;
    switch (pixels) {
        case PixelFormat::grey:
            return bytes_of(grey.clone());
        case PixelFormat::y16:
            grey.convertTo(image, CV_16U, 257.0);
            return bytes_of(image);
        case PixelFormat::yuyv:
            cv::merge(std::vector<cv::Mat>{grey, cv::Mat(grey.size(), CV_8UC1, cv::Scalar(128))}, image);
            return bytes_of(image);
        case PixelFormat::mjpeg:
            cv::imencode(".jpg", grey, jpeg, {cv::IMWRITE_JPEG_QUALITY, 100});
            return jpeg;
        default:
            throw std::logic_error("not a format that this test feeds");
    }
}

LoopbackFeed::LoopbackFeed(const std::filesystem::path& node, PixelFormat pixels, cv::Size size_px)
    : device_(open_or_throw(node)), pixels_(pixels) {
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    format.fmt.pix.width = static_cast<std::uint32_t>(size_px.width);
    format.fmt.pix.height = static_cast<std::uint32_t>(size_px.height);
    format.fmt.pix.pixelformat = vision::v4l2::fourcc_of(pixels);
    format.fmt.pix.field = V4L2_FIELD_NONE;
    format.fmt.pix.sizeimage = format.fmt.pix.width * format.fmt.pix.height * 2;
    const int error = device_.request(VIDIOC_S_FMT, &format);
    if (error != 0) throw std::runtime_error(device_.refusal("the feed's format is refused", error));
    if (format.fmt.pix.pixelformat != vision::v4l2::fourcc_of(pixels))
        throw std::runtime_error("the loopback does not take " + std::string(name_of(pixels)));
    show(cv::Mat(size_px, CV_8UC1, cv::Scalar(0)));
}

void LoopbackFeed::show(const cv::Mat& grey) {
    const std::vector<std::uint8_t> bytes = encoded(grey, pixels_);
    if (::write(device_.fd(), bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
        throw std::runtime_error("the loopback does not take the whole frame");
}

}  // namespace fidservo::devices
