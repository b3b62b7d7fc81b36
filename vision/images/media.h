// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Libraries for images and videos that are many and large, behind a module that is loaded at the first call:
// libtiff, FFmpeg's, and OpenCV's codecs.

#include "core/result.h"
#include "core/time.h"
#include "vision/images/image_file.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// An open video, decoded frame by frame. The boundary to the module's decoder.
class Video {
  public:
    struct Picture {
        StoredImage image{};              ///< if it is not damaged
        std::optional<TimeNs> time_ns{};  ///< its own time stamp, on the container's time line
        std::string
            damage{};  ///< why there is no image; so it is said of frames that build on a damaged one, too
    };

    Video() = default;
    Video(const Video&) = delete;
    Video& operator=(const Video&) = delete;
    virtual ~Video() = default;

    /// Frames in the order in which they are shown, damaged ones among them; empty after the last. Pixels are
    /// where the stream has them: a display matrix is not followed.
    virtual std::optional<Picture> next() = 0;
    /// How many packets the stream has, which is how many frames unless some are hidden.
    virtual std::size_t packets() const = 0;
    /// Whether every packet has a time stamp, no two the same one, and they rise.
    virtual bool has_times() const = 0;
    /// Samples of 16 bits of which the stream does not say how many are used.
    virtual bool has_open_range() const = 0;
    /// What a user would want to know: why there are no times, how players turn the picture, that there are
    /// other streams, that the file ends too early. One line each, without the file's name.
    virtual std::vector<std::string> notes() const = 0;
};

/// Reads all packets once, for what has_times() says. Fails with Reason::device: not a video that can be
/// decoded, or the module is not installed.
Result<std::unique_ptr<Video>> open_video(const std::filesystem::path& file);

/// Any image that OpenCV reads, CV_8UC1 or CV_16UC1. Fails with Reason::device, without the file's name.
Result<cv::Mat> read_with_opencv(const std::filesystem::path& file);

/// Has OpenCV a reader for what the file begins with?
bool is_image_for_opencv(const std::filesystem::path& file);

/// The pages of a TIFF; a page of it. As list_pages() and read_stored() say, without the file's name.
Result<std::vector<PageOfFile>> list_tiff_pages(const std::filesystem::path& file);
Result<StoredImage> read_tiff_page(const std::filesystem::path& file, std::uint64_t page);

/// What the module offers; its symbol is media_symbol, a constant of this type.
struct MediaModule {
    bool (*is_image)(const char* file);
    Result<cv::Mat> (*read_image)(const char* file);
    Result<std::vector<PageOfFile>> (*list_tiff_pages)(const char* file);
    Result<StoredImage> (*read_tiff_page)(const char* file, std::uint64_t page);
    Result<std::unique_ptr<Video>> (*open_video)(const char* file);
};
inline constexpr const char* media_symbol = "fidservo_media_module";

}  // namespace fidservo::vision
