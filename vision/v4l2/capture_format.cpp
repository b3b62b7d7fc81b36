// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/capture_format.h"

#include "core/input_error.h"
#include "vision/v4l2/format_list.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <linux/videodev2.h>

namespace fidservo::vision::v4l2 {

namespace {

std::string text_of(int width_px, int height_px, std::string_view pixels) {
    return fmt::format("{} x {} px {}", width_px, height_px, pixels);
}

const OfferedFormat* find_format(const std::vector<OfferedFormat>& offered, PixelFormat pixels) {
    const auto found = std::ranges::find(offered, fourcc_of(pixels), &OfferedFormat::fourcc);
    return found == offered.end() ? nullptr : &*found;
}

std::string names_of(const std::vector<OfferedFormat>& offered) {
    std::vector<std::string> names;
    for (const OfferedFormat& format : offered)
        if (const auto pixels = pixel_format_of(format.fourcc)) names.emplace_back(name_of(*pixels));
    return names.empty() ? "none that is understood" : fmt::format("{}", fmt::join(names, ", "));
}

bool offers_size(const OfferedFormat& format, const CaptureSettings& settings) {
    return format.sizes.empty() || std::ranges::any_of(format.sizes, [&](const OfferedSize& size) {
               return size.includes(settings.width_px, settings.height_px);
           });
}

/// The one that is asked for; else the first of the preferred ones that comes in the size asked for.
PixelFormat choose_pixels(const Device& device, const CaptureSettings& settings,
                          const std::vector<OfferedFormat>& offered) {
    if (settings.pixels) {
        if (find_format(offered, *settings.pixels) == nullptr)
            throw InputError(fmt::format("camera.capture.format: {}: {} does not offer it; allowed: {}",
                                         name_of(*settings.pixels), device.node().string(),
                                         names_of(offered)));
        return *settings.pixels;
    }
    const OfferedFormat* first = nullptr;
    for (const PixelFormat pixels : pixel_formats) {
        const OfferedFormat* format = find_format(offered, pixels);
        if (format == nullptr) continue;
        if (offers_size(*format, settings)) return pixels;
        if (first == nullptr) first = format;
    }
    if (first == nullptr) {
        std::vector<std::string_view> understood;
        understood.reserve(pixel_formats.size());
        for (const PixelFormat pixels : pixel_formats) understood.push_back(name_of(pixels));
        throw InputError(fmt::format("{}: offers no pixel format that is understood: {}",
                                     device.node().string(), fmt::join(understood, ", ")));
    }
    return *pixel_format_of(first->fourcc);
}

[[noreturn]] void refuse_size(const Device& device, const CaptureSettings& settings, PixelFormat pixels,
                              const std::vector<OfferedFormat>& offered) {
    std::vector<std::string> sizes;
    if (const OfferedFormat* format = find_format(offered, pixels))
        for (const OfferedSize& size : format->sizes) sizes.push_back(size_text(size));
    throw InputError(fmt::format(
        "camera.width_px, height_px: {} x {}: {} has no such size in {}; allowed: {}", settings.width_px,
        settings.height_px, device.node().string(), name_of(pixels), fmt::join(sizes, ", ")));
}

void ask_for_rate(const Device& device, double rate_hz) {
    constexpr double ticks_per_s = 10'000.0;  // drivers choose the nearest that they have
    v4l2_streamparm parameters{};
    parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    parameters.parm.capture.timeperframe = {static_cast<std::uint32_t>(ticks_per_s),
                                            static_cast<std::uint32_t>(std::lround(rate_hz * ticks_per_s))};
    (void)device.request(VIDIOC_S_PARM, &parameters);  // many have one rate, and no such request
}

v4l2_format format_of(const Device& device) {
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    (void)device.request(VIDIOC_G_FMT, &format);
    return format;
}

}  // namespace

std::string text_of(const CaptureFormat& format) {
    return text_of(format.width_px, format.height_px, name_of(format.pixels));
}

CaptureFormat set_format(const Device& device, const CaptureSettings& settings) {
    const std::vector<OfferedFormat> offered = offered_formats(device);
    const PixelFormat pixels = choose_pixels(device, settings, offered);
    v4l2_format format = format_of(device);
    auto& image = format.fmt.pix;
    image.width = static_cast<std::uint32_t>(settings.width_px);
    image.height = static_cast<std::uint32_t>(settings.height_px);
    image.pixelformat = fourcc_of(pixels);
    image.field = V4L2_FIELD_NONE;
    image.bytesperline = 0;
    image.sizeimage = 0;
    if (const int error = device.request(VIDIOC_S_FMT, &format); error != 0)
        throw RunFault(device.refusal("the format cannot be set (VIDIOC_S_FMT)", error));
    CaptureFormat got{pixels, static_cast<int>(image.width), static_cast<int>(image.height),
                      image.bytesperline, image.sizeimage};
    if (got.width_px != settings.width_px || got.height_px != settings.height_px)
        refuse_size(device, settings, pixels, offered);
    if (image.pixelformat != fourcc_of(pixels))
        throw RunFault(fmt::format("{}: set to {}, it sends {}", device.node().string(), text_of(got),
                                   fourcc_text(image.pixelformat)));
    const auto row_bytes = static_cast<std::size_t>(got.width_px) *
                           static_cast<std::size_t>(bytes_per_pixel(pixels).value_or(0));
    got.bytes_per_line = bytes_per_pixel(pixels) ? std::max(got.bytes_per_line, row_bytes) : 0;
    ask_for_rate(device, settings.frame_rate_hz);
    return got;
}

double frame_rate_hz(const Device& device) {
    v4l2_streamparm parameters{};
    parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (device.request(VIDIOC_G_PARM, &parameters) != 0) return 0.0;
    return rate_hz(parameters.parm.capture.timeperframe);
}

std::string format_in_force(const Device& device) {
    const v4l2_format format = format_of(device);
    const auto pixels = pixel_format_of(format.fmt.pix.pixelformat);
    return text_of(static_cast<int>(format.fmt.pix.width), static_cast<int>(format.fmt.pix.height),
                   pixels ? std::string(name_of(*pixels)) : fourcc_text(format.fmt.pix.pixelformat));
}

}  // namespace fidservo::vision::v4l2
