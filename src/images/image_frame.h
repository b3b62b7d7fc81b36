// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A frame of the images, stacks, recordings and videos that a user gives.
#include "core/result.h"
#include "core/time.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <opencv2/core/mat.hpp>

namespace fidservo {

/// Frames of one series belong together: their displacements have one origin, their grey levels one range.
struct ImageFrame {
    std::string
        name{};  ///< unique among the inputs: the file, with #0, #1 .. for frames of a stack or a video
    std::size_t series = 0;
    std::optional<TimeNs> time_ns{};  ///< middle of the exposure, where the input tells
    bool from_recording = false;      ///< taken by a rig's own camera
    std::filesystem::path file{};     ///< of an image or a stack
    std::uint64_t page = 0;           ///< the place of the stack's page in the file; 0: its first image
    int bits =
        16;  ///< of samples of more than 8 bits: 2^bits - 1 is full scale, decided for all of the series
    cv::Mat decoded{};               ///< CV_8UC1; images are decoded by load()
    std::string damage{};            ///< why it cannot be read: it is left out then, counted and named
    int orientation = 1;             ///< as EXIF numbers them; the pixels are where the file has them
    bool has_more_pictures = false;  ///< the file holds pictures besides this one that are not read
};

/// Decodes the frame if that was not done: `decoded`, or `damage` in one line. Whether it could be read.
/// Thread-safe for different frames.
bool load(ImageFrame& frame);

/// The frame's image, CV_8UC1. Throws InputError if it cannot be read.
cv::Mat decode(const ImageFrame& frame);

}  // namespace fidservo
