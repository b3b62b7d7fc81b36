#pragma once
// OpenCV's codecs for images and videos, behind a module that is loaded at the first call.

#include "core/result.h"

#include <filesystem>
#include <memory>
#include <optional>

#include <opencv2/core/mat.hpp>

namespace fidservo::vision {

/// An open video, decoded frame by frame. The boundary to the module's decoder.
class Video {
  public:
    struct Picture {
        cv::Mat grey;    ///< CV_8UC1
        double place_s;  ///< where the decoder said it stood before it decoded the frame
    };

    Video() = default;
    Video(const Video&) = delete;
    Video& operator=(const Video&) = delete;
    virtual ~Video() = default;

    /// Empty after the last frame.
    virtual std::optional<Picture> next() = 0;
    virtual double rate_hz() const = 0;             ///< as the container states it; 0: it does not
    virtual std::size_t stated_frames() const = 0;  ///< as the container states it, which may be wrong
};

/// Fails with Reason::device: not a video that can be decoded, or the module is not installed.
Result<std::unique_ptr<Video>> open_video(const std::filesystem::path& file);

/// Any image that OpenCV reads, as read_grey() says. Fails with Reason::device, naming the file.
Result<cv::Mat> read_grey_with_opencv(const std::filesystem::path& file);

/// What the module offers; its symbol is media_symbol, a constant of this type.
struct MediaModule {
    /// Empty: not an image. @param file  a path
    cv::Mat (*read_grey)(const char* file);
    /// Null: not a video. The caller owns it.
    Video* (*open_video)(const char* file);
};
inline constexpr const char* media_symbol = "fidservo_media_module";

}  // namespace fidservo::vision
