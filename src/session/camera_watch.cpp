// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/camera_watch.h"

#include "core/failure.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace fidservo {

namespace {

constexpr int least_frames = 5;
constexpr TimeNs most_between_polls_ns = 10 * ns_per_ms;  ///< longer: nobody was listening
constexpr TimeNs most_ahead_ns = 100 * ns_per_ms;         ///< drivers' stamps are that good
constexpr TimeNs most_behind_ns = ns_per_s;
constexpr int pixel_stride = 251;         ///< a prime: no column of the image is left out
constexpr unsigned char dark_level = 12;  ///< brighter than this is one pixel of a hundred, at least
constexpr unsigned char full_level = 255;
constexpr double most_full = 0.5;
constexpr double moved_mm = 0.1;  ///< 25 px on the reference rig
constexpr int moved_adc = 100;    ///< 120 um there

std::vector<unsigned char> sampled(const cv::Mat& image) {
    std::vector<unsigned char> pixels;
    pixels.reserve(image.total() / pixel_stride + 1);
    for (std::size_t at = 0; at < image.total(); at += pixel_stride) {
        const auto row = static_cast<int>(at / static_cast<std::size_t>(image.cols));
        pixels.push_back(image.ptr<unsigned char>(row)[at % static_cast<std::size_t>(image.cols)]);
    }
    return pixels;
}

std::optional<std::string> blindness(const std::vector<unsigned char>& pixels) {
    const auto count = static_cast<double>(pixels.size());
    const auto bright = std::ranges::count_if(pixels, [](unsigned char grey) { return grey > dark_level; });
    if (static_cast<double>(bright) < 0.01 * count) return "the image is black: light and exposure?";
    const auto full = std::ranges::count(pixels, full_level);
    if (static_cast<double>(full) > most_full * count)
        return fmt::format("{:.0f} % of the image is saturated: light and exposure?",
                           100.0 * static_cast<double>(full) / count);
    return std::nullopt;
}

std::optional<std::string> false_time(const vision::Frame& frame, TimeNs now_ns) {
    const double ahead_s = seconds(frame.time_ns - now_ns);
    if (frame.time_ns - now_ns > most_ahead_ns)
        return fmt::format("the camera's time stamps are {:.3f} s ahead of the stage's clock", ahead_s);
    if (now_ns - frame.time_ns > most_behind_ns)
        return fmt::format("the camera's time stamps are {:.3f} s behind the stage's clock", -ahead_s);
    return std::nullopt;
}

}  // namespace

Status CameraWatch::silent(TimeNs now_ns) {
    if (last_poll_ns_ && now_ns - *last_poll_ns_ <= most_between_polls_ns)
        silent_s_ += seconds(now_ns - *last_poll_ns_);
    last_poll_ns_ = now_ns;
    const double borne_s = params_.patience_s + least_frames * params_.frame_period_s + params_.reconnect_s;
    if (silent_s_ <= borne_s) return {};
    return failure(Reason::device, fmt::format("no frame from the camera for {:.1f} s", silent_s_));
}

bool CameraWatch::is_frozen(const vision::Frame& frame, const std::vector<unsigned char>& pixels,
                            const control::StageSample& stage) {
    if (!seen_ || seen_->pixels != pixels) {
        seen_ = Seen{pixels, stage, std::nullopt};
        return false;
    }
    const auto counts = static_cast<double>(stage.encoder_count - seen_->stage.encoder_count);
    const bool moved = std::abs(counts) * params_.count_mm > moved_mm ||
                       std::abs(stage.hall_adc - seen_->stage.hall_adc) > moved_adc;
    if (moved && !seen_->moved_ns) seen_->moved_ns = stage.time_ns;
    return seen_->moved_ns && frame.time_ns > *seen_->moved_ns;
}

Result<std::optional<vision::Frame>> CameraWatch::admit(std::optional<vision::Frame> frame,
                                                        const control::StageSample& stage) {
    if (!frame) {
        if (auto heard = silent(stage.time_ns); !heard) return tl::make_unexpected(heard.error());
        return std::nullopt;
    }
    silent_s_ = 0.0;
    last_poll_ns_ = stage.time_ns;
    const std::vector<unsigned char> pixels = sampled(frame->image);
    const auto wrong_time = false_time(*frame, stage.time_ns);
    auto complaint = wrong_time ? wrong_time : blindness(pixels);
    if (!complaint && is_frozen(*frame, pixels, stage))
        complaint = "the camera shows the same image although the stage has moved";
    if (!complaint) {
        trouble_.reset();
        return frame;
    }
    if (!trouble_) trouble_ = Trouble{stage.time_ns, 0};
    ++trouble_->frames;
    if (trouble_->frames > least_frames &&
        stage.time_ns - trouble_->since_ns >= nanoseconds(params_.patience_s))
        return failure(Reason::device, *complaint);
    if (wrong_time) return std::nullopt;
    return frame;
}

}  // namespace fidservo
