// SPDX-License-Identifier: GPL-3.0-or-later
// The module's door: the only place that sees OpenCV's image codecs, libtiff and FFmpeg's libraries.
#include "core/failure.h"
#include "vision/images/media.h"
#include "vision/images/module/parts.h"

#include <iostream>
#include <streambuf>
#include <utility>

#include <opencv2/imgcodecs.hpp>

namespace fidservo::vision {
namespace {

/// Stands before the buffer of std::cerr and drops what a thread writes there while OpenCV decodes for it:
/// OpenCV prints its exceptions, source lines and all, and whoever asked for the image says what is wrong
/// with it.
class WithoutOpenCvsLines final : public std::streambuf {
  public:
    WithoutOpenCvsLines(const WithoutOpenCvsLines&) = delete;
    WithoutOpenCvsLines& operator=(const WithoutOpenCvsLines&) = delete;
    ~WithoutOpenCvsLines() override { std::cerr.rdbuf(behind_); }

    template <class Decode>
    static auto call(Decode decode) {
        static WithoutOpenCvsLines installed;
        struct Quiet {
            bool before = std::exchange(is_quiet, true);
            ~Quiet() { is_quiet = before; }
        };
        const Quiet quiet;
        return decode();
    }

  private:
    WithoutOpenCvsLines() : behind_(std::cerr.rdbuf(this)) {}

    int_type overflow(int_type letter) override {
        if (is_quiet || traits_type::eq_int_type(letter, traits_type::eof()))
            return traits_type::not_eof(letter);
        return behind_->sputc(traits_type::to_char_type(letter));
    }
    std::streamsize xsputn(const char* text, std::streamsize count) override {
        return is_quiet ? count : behind_->sputn(text, count);
    }
    int sync() override { return behind_->pubsync(); }

    static thread_local bool is_quiet;
    std::streambuf* behind_;
};

thread_local bool WithoutOpenCvsLines::is_quiet = false;

bool is_image(const char* file) {
    try {
        return WithoutOpenCvsLines::call([&] { return cv::haveImageReader(file); });
    } catch (const cv::Exception&) {
        return false;
    }
}

Result<cv::Mat> read_image(const char* file) {
    constexpr int as_stored = cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION;
    cv::Mat grey;
    try {
        grey = WithoutOpenCvsLines::call([&] { return cv::imread(file, as_stored); });
    } catch (const cv::Exception&) {
        return failure(Reason::device, "its header is damaged");
    }
    if (grey.empty())
        return failure(Reason::device,
                       is_image(file) ? "it is damaged" : "it is of no format of images that is read");
    if (grey.type() != CV_8UC1 && grey.type() != CV_16UC1)
        return failure(Reason::device,
                       "its samples are not whole numbers of 8 or 16 bits: save it with those");
    return grey;
}

}  // namespace
}  // namespace fidservo::vision

extern "C" {
extern const fidservo::vision::MediaModule fidservo_media_module;
const fidservo::vision::MediaModule fidservo_media_module{
    &fidservo::vision::is_image, &fidservo::vision::read_image, &fidservo::vision::tiff_pages,
    &fidservo::vision::tiff_page, &fidservo::vision::ffmpeg_video};
}
