// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/format_list.h"

#include <algorithm>

#include <fmt/format.h>
#include <linux/videodev2.h>

namespace fidservo::vision::v4l2 {

namespace {

/// Against drivers that list without end.
constexpr std::uint32_t most_entries = 256;

std::vector<double> rates_of(const Device& device, std::uint32_t fourcc, const OfferedSize& size) {
    std::vector<double> rates;
    for (std::uint32_t k = 0; k < most_entries; ++k) {
        v4l2_frmivalenum entry{};
        entry.index = k;
        entry.pixel_format = fourcc;
        entry.width = static_cast<std::uint32_t>(size.most_width_px);
        entry.height = static_cast<std::uint32_t>(size.most_height_px);
        if (device.request(VIDIOC_ENUM_FRAMEINTERVALS, &entry) != 0) break;
        if (entry.type != V4L2_FRMIVAL_TYPE_DISCRETE) {
            rates = {rate_hz(entry.stepwise.max), rate_hz(entry.stepwise.min)};
            break;
        }
        rates.push_back(rate_hz(entry.discrete));
    }
    std::erase(rates, 0.0);
    std::ranges::sort(rates);
    return rates;
}

OfferedSize size_of(const v4l2_frmsizeenum& entry) {
    const auto px = [](std::uint32_t value) { return static_cast<int>(value); };
    if (entry.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
        const auto& one = entry.discrete;
        return {px(one.width), px(one.height), px(one.width), px(one.height), 0, 0, {}};
    }
    const auto& range = entry.stepwise;
    return {px(range.min_width),
            px(range.min_height),
            px(range.max_width),
            px(range.max_height),
            std::max(1, px(range.step_width)),
            std::max(1, px(range.step_height)),
            {}};
}

std::vector<OfferedSize> sizes_of(const Device& device, std::uint32_t fourcc) {
    std::vector<OfferedSize> sizes;
    for (std::uint32_t k = 0; k < most_entries; ++k) {
        v4l2_frmsizeenum entry{};
        entry.index = k;
        entry.pixel_format = fourcc;
        if (device.request(VIDIOC_ENUM_FRAMESIZES, &entry) != 0) break;
        OfferedSize size = size_of(entry);
        size.rates_hz = rates_of(device, fourcc, size);
        sizes.push_back(std::move(size));
        if (entry.type != V4L2_FRMSIZE_TYPE_DISCRETE) break;
    }
    return sizes;
}

}  // namespace

bool OfferedSize::includes(int width_px, int height_px) const {
    if (is_single()) return width_px == most_width_px && height_px == most_height_px;
    return width_px >= least_width_px && width_px <= most_width_px && height_px >= least_height_px &&
           height_px <= most_height_px && (width_px - least_width_px) % step_width_px == 0 &&
           (height_px - least_height_px) % step_height_px == 0;
}

std::vector<OfferedFormat> offered_formats(const Device& device) {
    std::vector<OfferedFormat> formats;
    for (std::uint32_t k = 0; k < most_entries; ++k) {
        v4l2_fmtdesc entry{};
        entry.index = k;
        entry.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
        if (device.request(VIDIOC_ENUM_FMT, &entry) != 0) break;
        formats.push_back({entry.pixelformat, reinterpret_cast<const char*>(entry.description),
                           sizes_of(device, entry.pixelformat)});
    }
    return formats;
}

double rate_hz(const v4l2_fract& period_s) {
    return period_s.numerator == 0 ? 0.0 : static_cast<double>(period_s.denominator) / period_s.numerator;
}

std::string size_text(const OfferedSize& size) {
    const std::string largest = fmt::format("{}x{}", size.most_width_px, size.most_height_px);
    if (size.is_single()) return largest;
    return fmt::format("{}x{} to {} in steps of {}x{}", size.least_width_px, size.least_height_px, largest,
                       size.step_width_px, size.step_height_px);
}

}  // namespace fidservo::vision::v4l2
