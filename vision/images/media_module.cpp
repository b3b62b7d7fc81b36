// The module: the only place that sees OpenCV's image codecs and its video decoders.
#include "vision/images/media.h"

#include <algorithm>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace fidservo::vision {
namespace {

cv::Mat read_grey(const char* file) {
    try {
        return cv::imread(file, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
    } catch (const cv::Exception&) {
        return {};  // too large, or a broken header
    }
}

/// Any depth and any number of channels to 8-bit grey.
cv::Mat grey_of(const cv::Mat& image) {
    cv::Mat grey;
    switch (image.channels()) {
        case 3:
            cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
            break;
        case 4:
            cv::cvtColor(image, grey, cv::COLOR_BGRA2GRAY);
            break;
        default:
            grey = image.clone();  // the decoder writes its next frame into the same memory
    }
    if (grey.depth() == CV_16U) grey.convertTo(grey, CV_8U, 1.0 / 257.0);
    return grey;
}

class DecodedVideo final : public Video {
  public:
    explicit DecodedVideo(const char* file) : capture_(file, cv::CAP_FFMPEG) {}

    bool is_open() const { return capture_.isOpened(); }

    std::optional<Picture> next() override {
        constexpr double s_per_ms = 1e-3;
        const double place_s = capture_.get(cv::CAP_PROP_POS_MSEC) * s_per_ms;
        cv::Mat image;
        if (!capture_.read(image) || image.empty()) return std::nullopt;
        return Picture{grey_of(image), place_s};
    }

    double rate_hz() const override { return std::max(0.0, capture_.get(cv::CAP_PROP_FPS)); }

    std::size_t stated_frames() const override {
        return static_cast<std::size_t>(std::max(0.0, capture_.get(cv::CAP_PROP_FRAME_COUNT)));
    }

  private:
    cv::VideoCapture capture_;
};

Video* open_decoded(const char* file) {
    auto video = std::make_unique<DecodedVideo>(file);
    return video->is_open() ? video.release() : nullptr;
}

}  // namespace
}  // namespace fidservo::vision

extern "C" {
extern const fidservo::vision::MediaModule fidservo_media_module;
const fidservo::vision::MediaModule fidservo_media_module{&fidservo::vision::read_grey,
                                                          &fidservo::vision::open_decoded};
}
