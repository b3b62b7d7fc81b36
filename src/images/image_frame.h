// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A frame of the images, stacks, recordings and videos given by the user.
#include "core/result.h"
#include "core/time.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <opencv2/core/mat.hpp>

namespace fidservo {

/// A frame and its series (image_list.h): displacements are counted from the first frame of a series, and
/// grey levels have one range in it.
struct ImageFrame {
    std::string
        name{};  ///< unique among the inputs: the file, with #0, #1 .. for frames of a stack or a video
    std::size_t series = 0;
    std::optional<TimeNs> time_ns{};  ///< middle of the exposure, where the input states it
    bool from_recording = false;      ///< taken by a rig's own camera
    std::filesystem::path file{};     ///< of an image or a stack
    std::uint64_t page = 0;           ///< file offset of the stack's page; 0: the first image
    /// For samples of more than 8 bits: 2^bits - 1 is full scale, the same for the whole series.
    int bits = 16;
    cv::Mat decoded{};               ///< CV_8UC1; frames of images are decoded by load()
    std::string damage{};            ///< why it cannot be read; it is then left out, counted and named
    int orientation = 1;             ///< EXIF orientation; the pixels are not rotated accordingly
    bool has_more_pictures = false;  ///< the file has further pictures, which are not read
};

/// Decodes the frame if that has not been done: sets `decoded`, or `damage` to one line. Returns whether it
/// could be read. Thread-safe for different frames.
bool load(ImageFrame& frame);

/// The frame's image, CV_8UC1. Throws InputError if it cannot be read.
cv::Mat decode(const ImageFrame& frame);

}  // namespace fidservo
