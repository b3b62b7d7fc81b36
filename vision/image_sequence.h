#pragma once
// Images on disk as a camera: a recording's cam0 folder, a folder of images, one image, a video.
#include "core/result.h"
#include "vision/camera.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace fidservo::vision {

/// Where to find a frame, without decoding it.
struct FrameReference {
    std::filesystem::path file;  ///< an image; empty for a frame of a video
    TimeNs time_ns = 0;
    bool timed = false;  ///< false: the image has no time; time_ns counts frames of 1/fps
    std::uint64_t sequence = 0;
};

/// The images that an input stands for, in order.
///   folder with data.csv (EuRoC cam0: "#timestamp [ns],filename", images in data/): in the file's order,
///   timed; a recording folder: its cam0;  any other folder: its images in natural order (frame2 before
///   frame10); an image: itself.
/// Throws InputError: no such file or folder, no image in it, a bad line in data.csv.
std::vector<FrameReference> list_images(const std::filesystem::path& input);

/// Is this the name of an image file that can be decoded? By its extension.
bool is_image_file(const std::filesystem::path& file);
bool is_video_file(const std::filesystem::path& file);

/// Decodes an image to 8-bit grey. Thread-safe. Fails with Reason::device and names the file.
Result<Frame> load_frame(const FrameReference& reference);

/// Natural order of names: digits compare as numbers, the rest byte by byte.
bool natural_less(const std::string& a, const std::string& b);

/// Frames one after another; poll() hands them out as fast as it is called.
class ImageSequence final : public Camera {
  public:
    /// @param input  what list_images() takes, or a video. Throws InputError.
    /// @param rate_hz  frame rate for images without times
    explicit ImageSequence(const std::filesystem::path& input, double rate_hz = 50.0);
    ~ImageSequence() override;

    /// The next frame; empty after the last. An unreadable image fails with Reason::device and is passed
    /// over: the call after it goes on with the next one.
    Result<std::optional<Frame>> next();

    /// The same as next(), whatever the time: images on disk have all arrived.
    Result<std::optional<Frame>> poll(TimeNs now_ns) override;

    /// How many frames there are; for videos what the container says, which may be wrong.
    std::size_t size() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fidservo::vision
