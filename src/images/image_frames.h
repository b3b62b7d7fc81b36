// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The one reader of images: recordings, folders, stacks, videos and single images as one ordered sequence.
#include "src/images/image_frame.h"
#include "src/images/image_list.h"
#include "src/images/image_names.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fidservo {

struct ImageOptions {
    NameTimes name_times = NameTimes::automatic;
    bool one_range = false;  ///< one range of grey levels for all inputs, not one for each series
};

/// The frames of all inputs (image_list.h), in order.
class ImageFrames {
  public:
    /// Looks at every input. Images whose samples have more than 8 bits, and videos of 16 bits that do not
    /// say how many are used, are decoded once for their range: full scale is decided for a series, not for
    /// each frame. Throws InputError if an input does not exist, cannot be read or holds no image.
    explicit ImageFrames(const std::vector<std::filesystem::path>& inputs, const ImageOptions& options = {});
    ~ImageFrames();

    /// The number of frames, damaged ones included; of a video, the number of packets.
    std::size_t size() const { return size_; }
    /// Names of frames that an index lists and that do not exist.
    const std::vector<std::string>& missing() const { return missing_; }
    /// Whether all frames are of one series and have times.
    bool is_one_timed_series() const { return is_one_timed_series_; }
    /// Frames of one folder or video, or all images that were given by name.
    struct Series {
        std::string name;    ///< of images given by name the first one's file
        std::size_t frames;  ///< as size() counts them
        bool is_video;
    };
    std::vector<Series> series() const;
    /// The `name` of a frame in a series.
    std::string frame_name(std::size_t series, std::size_t frame) const;

    /// Closes the files that are open; seek() opens them again.
    void pause();
    /// Makes this frame of this series the next one. A video is reopened and decoded up to there.
    void seek(std::size_t series, std::size_t frame);
    /// The next frame; empty after the last. Videos are decoded here; images by load().
    std::optional<ImageFrame> next();
    /// What a user would want to know: what was passed over, where times come from and why there are none,
    /// how many bits are used, that players turn a picture. One line each.
    const std::vector<std::string>& notes() const { return list_.notes; }

  private:
    class OpenVideo;

    void open_videos();
    void decide_ranges(bool one_range);
    bool has_times(std::size_t series) const;

    ImageList list_;
    std::vector<std::unique_ptr<OpenVideo>> videos_;  ///< by series; null for images, and after pause()
    std::vector<std::size_t> sizes_;                  ///< by series
    std::vector<int> video_bits_;                     ///< by series; 0: as each frame states
    bool is_one_timed_series_ = false;
    std::vector<std::string> missing_;
    std::size_t size_ = 0;
    std::size_t current_series_ = 0;
    std::size_t current_frame_ = 0;
};

}  // namespace fidservo
