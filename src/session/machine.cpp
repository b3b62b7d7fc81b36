// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/session/machine.h"

#include "core/failure.h"
#include "src/live/live_feed.h"
#include "src/process/interrupt.h"

#include <chrono>
#include <string>
#include <utility>

namespace fidservo {

Machine::~Machine() {
    (void)switch_off();
}

Result<control::StageSample> Machine::begin_tick() {
    if (interrupt_requested()) return note_end({Reason::stopped, "stopped by the user"});
    auto sample = devices_.stage->read();
    if (!sample) return note_end(std::move(sample.error()));
    now_ns_ = sample->time_ns;
    return sample;
}

Status Machine::end_tick(const control::StageSample& sample, const control::StageCommand& command,
                         const Setpoints& setpoints) {
    if (auto written = devices_.stage->write(command); !written) return note_end(std::move(written.error()));
    return record(sample, command, setpoints);
}

Status Machine::record(const control::StageSample& sample, const control::StageCommand& command,
                       const Setpoints& setpoints) {
    sample_ = sample;
    now_ns_ = sample.time_ns;
    if (!first_ns_) first_ns_ = now_ns_;
    if (!recorder_ && !feed_) return {};
    StageRow row;
    row.time_ns = sample.time_ns;
    row.macro_setpoint_mm = setpoints.macro_mm;
    row.macro_command_V = command.macro_V;
    row.encoder_count = static_cast<double>(sample.encoder_count);
    row.micro_setpoint_mm = setpoints.micro_mm;
    row.micro_command_V = command.micro_V;
    row.hall_adc = sample.hall_adc;
    if (feed_) feed_->tick(row);
    return recorder_ ? recorder_->add(row) : Status();
}

void Machine::wait_for_ticks() {
    constexpr std::chrono::milliseconds a_few_ticks{2};
    devices_.loop->wait(a_few_ticks);
}

Status Machine::record_ticks(bool& was_last) {
    while (!was_last) {
        const auto record = devices_.loop->next();
        if (!record) return {};
        was_last = record->step.done;
        const Setpoints setpoints{record->step.macro_setpoint_mm, record->step.micro_setpoint_mm};
        if (auto kept = this->record(record->sample, record->step.command, setpoints); !kept) return kept;
    }
    return {};
}

Status Machine::skip_held() {
    while (const auto held = devices_.loop->next())
        if (auto kept = record(held->sample, held->step.command, {}); !kept) return kept;
    return {};
}

Result<std::optional<vision::Frame>> Machine::poll_camera() {
    auto frame = devices_.camera->poll(now_ns_);
    if (!frame) return note_end({Reason::device, std::move(frame.error().text)});  // it fails for good
    if (*frame && now_ns_ - counted_ns_ >= ns_per_s) note_missing_frames();
    auto admitted = camera_watch_.admit(std::move(*frame), sample_);
    if (!admitted) return note_end(std::move(admitted.error()));
    if (feed_ && *admitted) feed_->saw(**admitted);
    return admitted;
}

Status Machine::keep(const std::vector<TagDetection>& found, const std::vector<TagDetection>& measured) {
    if (feed_) feed_->found(found);
    if (!recorder_) return {};
    for (const TagDetection& detection : measured)
        if (auto kept = recorder_->add(detection); !kept) return kept;
    return {};
}

Status Machine::keep(const vision::Frame& frame) {
    return recorder_ ? recorder_->add_frame(frame.time_ns, frame.image) : Status();
}

void Machine::note(std::string what, std::string text) {
    if (recorder_) recorder_->add(RecordingEvent{now_ns_, std::move(what), std::move(text)});
}

tl::unexpected<Failure> Machine::note_end(Failure why) {
    if (!std::exchange(end_noted_, true)) note(why.reason == Reason::stopped ? "stopped" : "fault", why.text);
    return tl::make_unexpected(std::move(why));
}

void Machine::note_missing_frames() {
    const vision::FrameCounts counts = devices_.camera->counts();
    if (counts.lost > counts_.lost) note("frames_lost", std::to_string(counts.lost - counts_.lost));
    if (counts.damaged > counts_.damaged)
        note("frames_damaged", std::to_string(counts.damaged - counts_.damaged));
    counts_ = counts;
    counted_ns_ = now_ns_;
}

void Machine::record_to(std::unique_ptr<RecordingWriter> recorder) {
    recorder_ = std::move(recorder);
    end_noted_ = false;
    counts_ = devices_.camera->counts();
}

Status Machine::end_recording(const std::optional<EncoderZero>& zero) {
    const auto recorder = take_recorder(zero);
    return recorder ? recorder->close() : Status();
}

void Machine::leave_recording(const std::optional<EncoderZero>& zero) {
    (void)take_recorder(zero);
}

std::unique_ptr<RecordingWriter> Machine::take_recorder(const std::optional<EncoderZero>& zero) {
    if (!recorder_) return nullptr;
    note_missing_frames();
    if (zero) recorder_->set_encoder_zero(*zero);
    return std::move(recorder_);
}

void Machine::set_travel(const control::CarriageTravel& travel) {
    if (devices_.loop) devices_.loop->set_travel(travel);
}

std::optional<control::LoopStatistics> Machine::loop_statistics() const {
    if (!devices_.loop) return std::nullopt;
    return devices_.loop->statistics();
}

Status Machine::switch_off() {
    return devices_.loop ? devices_.loop->stop() : devices_.stage->write({});
}

}  // namespace fidservo
