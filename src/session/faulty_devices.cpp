// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/faulty_devices.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace fidservo {

namespace {

constexpr TimeNs clock_step_ns = 2 * ns_per_s;
constexpr TimeNs lateness_ns = 100 * ns_per_ms;
constexpr std::int64_t jump_count = 400;
constexpr double dark_gain = 0.02, bright_gain = 20.0;
constexpr double bar_height = 0.12;  ///< of the image
constexpr double bar_level = 90.0;

bool any_on(const std::vector<Fault>& faults, FaultKind kind, TimeNs now_ns) {
    return std::ranges::any_of(faults,
                               [&](const Fault& fault) { return fault.kind == kind && fault.is_on(now_ns); });
}

cv::Mat scaled(const cv::Mat& image, double gain) {
    cv::Mat result;
    image.convertTo(result, CV_8U, gain);
    return result;
}

cv::Mat with_a_bar(const cv::Mat& image) {
    cv::Mat result = image.clone();
    const auto height = static_cast<int>(bar_height * image.rows);
    result.rowRange((image.rows - height) / 2, (image.rows + height) / 2).setTo(bar_level);
    return result;
}

}  // namespace

bool FaultyStage::is_on(FaultKind kind) const {
    return any_on(faults_, kind, now_ns_);
}

Result<control::StageSample> FaultyStage::read() {
    auto sample = stage_->read();
    if (!sample) return sample;
    now_ns_ = sample->time_ns;
    if (is_on(FaultKind::encoder_jump)) sample->encoder_count += jump_count;
    if (!is_on(FaultKind::hall_stuck))
        stuck_adc_.reset();
    else if (!stuck_adc_)
        stuck_adc_ = sample->hall_adc;
    sample->hall_adc = stuck_adc_.value_or(sample->hall_adc);
    if (is_on(FaultKind::stage_clock_step)) sample->time_ns += clock_step_ns;
    return sample;
}

Status FaultyStage::write(const control::StageCommand& command) {
    return stage_->write({is_on(FaultKind::macro_jammed) ? 0.0 : command.macro_V,
                          is_on(FaultKind::heater_dead) ? 0.0 : command.micro_V});
}

bool FaultyCamera::is_on(FaultKind kind, TimeNs now_ns) const {
    return any_on(faults_, kind, now_ns);
}

std::optional<vision::Frame> FaultyCamera::spoilt(vision::Frame frame, TimeNs now_ns) {
    const auto on = [&](FaultKind kind) { return is_on(kind, now_ns); };
    if (on(FaultKind::camera_silent) || (on(FaultKind::frames_dropped) && frame.sequence % 3 != 0)) {
        ++lost_;
        return std::nullopt;
    }
    if (!on(FaultKind::image_frozen))
        frozen_.release();
    else if (frozen_.empty())
        frozen_ = frame.image;
    else
        frame.image = frozen_;
    if (on(FaultKind::image_dark)) frame.image = scaled(frame.image, dark_gain);
    if (on(FaultKind::image_bright)) frame.image = scaled(frame.image, bright_gain);
    if (on(FaultKind::tag_hidden)) frame.image = with_a_bar(frame.image);
    if (on(FaultKind::camera_clock_step)) frame.time_ns += clock_step_ns;
    return frame;
}

std::optional<vision::Frame> FaultyCamera::newest_due(TimeNs now_ns) {
    std::optional<vision::Frame> newest;
    while (!late_.empty() && late_.front().due_ns <= now_ns) {
        newest = std::move(late_.front().frame);
        late_.pop_front();
    }
    return newest;
}

Result<std::optional<vision::Frame>> FaultyCamera::poll(TimeNs now_ns) {
    auto frame = camera_->poll(now_ns);
    if (!frame) return frame;
    if (*frame)
        if (auto come = spoilt(std::move(**frame), now_ns)) {
            const TimeNs late_ns = is_on(FaultKind::frames_late, now_ns) ? lateness_ns : 0;
            come->arrival_ns += late_ns;
            late_.push_back({now_ns + late_ns, std::move(*come)});
        }
    auto due = newest_due(now_ns);
    handed_out_ += due.has_value();
    return due;
}

vision::FrameCounts FaultyCamera::counts() const {
    vision::FrameCounts counts = camera_->counts();
    counts.lost += lost_;
    counts.handed_out = handed_out_;
    return counts;
}

}  // namespace fidservo
