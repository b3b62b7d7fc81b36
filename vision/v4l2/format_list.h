// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The pixel formats, image sizes and frame rates that a camera offers.
#include "vision/v4l2/device.h"
#include "vision/v4l2/pixel_format.h"

#include <cstdint>
#include <string>
#include <vector>

struct v4l2_fract;

namespace fidservo::vision::v4l2 {

/// A single image size, or a range from the smallest to the largest in steps.
struct OfferedSize {
    int least_width_px, least_height_px;
    int most_width_px, most_height_px;
    int step_width_px = 0, step_height_px = 0;  ///< 0: a single size
    std::vector<double> rates_hz;               ///< frame rates at the largest size; of a range its two ends

    bool is_single() const { return step_width_px == 0; }
    bool includes(int width_px, int height_px) const;
};

struct OfferedFormat {
    std::uint32_t fourcc;
    std::string description;  ///< as the driver words it
    std::vector<OfferedSize> sizes;
};

/// All formats in the driver's order. Lists that the driver does not provide are empty.
std::vector<OfferedFormat> offered_formats(const Device& device);

/// The frame rate for a frame interval; 0 if the driver does not know it.
double rate_hz(const v4l2_fract& period_s);

/// A size in words: "640x480", "16x16 to 4096x2160 in steps of 2x2".
std::string size_text(const OfferedSize& size);

}  // namespace fidservo::vision::v4l2
