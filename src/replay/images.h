#pragma once
// What `replay` reads: recording folders, image folders, videos, single images, as one ordered sequence of
// frames.
#include "core/time.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo {

/// A frame that is to be decoded. Frames of one series belong together: their displacements have one origin.
struct ReplayFrame {
    std::string name;  ///< unique among the inputs
    std::size_t series = 0;
    std::optional<TimeNs> time_ns{};  ///< middle of the exposure, where the input tells
    bool from_recording = false;      ///< taken by a rig's own camera
    std::filesystem::path file{};     ///< of an image
    cv::Mat decoded{};                ///< of a video; images are decoded by those who need them
};

/// The frames of all inputs, in order.
class ReplayFrames {
  public:
    /// Looks at every input without decoding images. Throws InputError if one does not exist, cannot be read
    /// or holds no image.
    explicit ReplayFrames(const std::vector<std::filesystem::path>& inputs);
    ~ReplayFrames();

    /// How many frames there are; a video's number is what its header says.
    std::size_t size() const { return size_; }
    /// All frames belong to one series and have times.
    bool is_one_timed_series() const;
    /// The next frame; empty after the last. Videos are decoded here. Throws InputError.
    std::optional<ReplayFrame> next();

  private:
    struct Video;
    struct Series {
        std::vector<ReplayFrame> images;
        std::unique_ptr<Video> video;
    };

    void add(const std::filesystem::path& input);
    void add_recording(const std::filesystem::path& folder);
    void add_image_folder(const std::filesystem::path& folder);
    void add_video(const std::filesystem::path& file);

    std::vector<Series> series_;
    std::size_t size_ = 0;
    std::size_t current_series_ = 0;
    std::size_t current_image_ = 0;
};

/// The frame's image, CV_8UC1, pixels as stored (an orientation tag is not followed). Throws InputError if it
/// cannot be read.
cv::Mat decode(const ReplayFrame& frame);

}  // namespace fidservo
