// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The large libraries for images and videos (libtiff, FFmpeg, OpenCV's codecs), behind a module that is
// loaded at the first call.

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
        StoredImage image{};              ///< the frame, if it is not damaged
        std::optional<TimeNs> time_ns{};  ///< its own time stamp, on the container's time line
        /// Why there is no image; set also for frames that are predicted from a damaged one.
        std::string damage{};
    };

    Video() = default;
    Video(const Video&) = delete;
    Video& operator=(const Video&) = delete;
    virtual ~Video() = default;

    /// Frames in display order, damaged ones included; empty after the last. Pixels are in the order of the
    /// stream: a display matrix is not applied.
    virtual std::optional<Picture> next() = 0;
    /// The number of packets in the stream, which is that of its frames unless some are hidden.
    virtual std::size_t packets() const = 0;
    /// Whether every packet has a time stamp and the time stamps strictly increase.
    virtual bool has_times() const = 0;
    /// Whether samples have 16 bits and the stream does not state how many of them are in use.
    virtual bool has_open_range() const = 0;
    /// Notes for the user: why there are no times, how players rotate the picture, that there are other
    /// streams, that the file ends too early. One line each, without the file's name.
    virtual std::vector<std::string> notes() const = 0;
};

/// Opens a video and reads all packets once, to know what has_times() returns. Fails with Reason::device: not
/// a video that can be decoded, or the module is not installed.
Result<std::unique_ptr<Video>> open_video(const std::filesystem::path& file);

/// Any image that OpenCV reads, CV_8UC1 or CV_16UC1. Fails with Reason::device, without the file's name.
Result<cv::Mat> read_with_opencv(const std::filesystem::path& file);

/// Whether OpenCV has a decoder for what the file begins with.
bool is_image_for_opencv(const std::filesystem::path& file);

/// The pages of a TIFF, and one of them, as list_pages() and read_stored() return them; failures are without
/// the file's name.
Result<std::vector<PageOfFile>> list_tiff_pages(const std::filesystem::path& file);
Result<StoredImage> read_tiff_page(const std::filesystem::path& file, std::uint64_t page);

/// The module's functions; its exported symbol media_symbol is a constant of this type.
struct MediaModule {
    bool (*is_image)(const char* file);
    Result<cv::Mat> (*read_image)(const char* file);
    Result<std::vector<PageOfFile>> (*list_tiff_pages)(const char* file);
    Result<StoredImage> (*read_tiff_page)(const char* file, std::uint64_t page);
    Result<std::unique_ptr<Video>> (*open_video)(const char* file);
};
inline constexpr const char* media_symbol = "fidservo_media_module";

}  // namespace fidservo::vision
