// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/comedi/comedi_board.h"

#include "core/failure.h"
#include "core/input_error.h"
#include "core/monotonic_clock.h"

#include <cmath>

namespace fidservo::control::comedi {

ComediOutputs::ComediOutputs(std::unique_ptr<BoardLink> board, const Wiring& wiring)
    : board_(std::move(board)), wiring_(wiring) {
    if (!wiring_.direction) return;
    const Address& line = wiring_.direction->at;
    if (board_->kind(line.subdevice) == SubdeviceKind::digital_io &&
        !board_->make_output(line.subdevice, line.channel))
        throw RunFault("the board does not make the direction's line an output");
}

bool ComediOutputs::set_macro(double volts) noexcept {
    return board_->write(wiring_.macro.at, number_of(wiring_.macro, volts));
}

bool ComediOutputs::write(const StageCommand& command) noexcept {
    bool taken = board_->write(wiring_.micro.at, number_of(wiring_.micro, command.micro_V));
    const double macro_V = wiring_.macro_reversed ? -command.macro_V : command.macro_V;
    if (!wiring_.direction) return set_macro(macro_V) && taken;
    const bool forward = macro_V == 0.0 ? forward_ : macro_V > 0.0;
    if (forward != forward_) {
        taken = set_macro(0.0) && taken;
        forward_ = forward;
    }
    taken = board_->write(wiring_.direction->at, forward ? 1 : 0) && taken;
    return set_macro(std::abs(macro_V)) && taken;
}

std::int64_t Unwrapped::follow(std::uint32_t reading) noexcept {
    const std::uint32_t moved = (reading - last_.value_or(reading)) & max_value_;
    last_ = reading;
    count_ +=
        moved <= max_value_ / 2 ? std::int64_t{moved} : std::int64_t{moved} - std::int64_t{max_value_} - 1;
    return count_;
}

ComediStage::ComediStage(std::unique_ptr<BoardLink> board, const Wiring& wiring,
                         std::shared_ptr<Guardian> guardian)
    : board_(std::move(board)),
      wiring_(wiring),
      guardian_(std::move(guardian)),
      counter_(wiring.encoder.max_value) {}

std::int64_t ComediStage::count_of(std::uint32_t reading) noexcept {
    const std::int64_t count = wiring_.counts_per_V
                                   ? std::llround(volts_of(wiring_.encoder, reading) * *wiring_.counts_per_V)
                                   : counter_.follow(reading);
    return wiring_.encoder_reversed ? -count : count;
}

Result<StageSample> ComediStage::read() {
    std::uint32_t encoder = 0;
    std::uint32_t hall = 0;
    StageSample sample;
    sample.time_ns = monotonic_now_ns();
    if (!board_->read(wiring_.encoder.at, encoder))
        return failure(Reason::device, "the board does not give the encoder");
    if (!board_->read(wiring_.hall.at, hall))
        return failure(Reason::device, "the board does not give the Hall sensor");
    sample.encoder_count = count_of(encoder);
    sample.hall_adc = static_cast<int>(std::lround(volts_of(wiring_.hall, hall) / wiring_.hall_lsb_V));
    return sample;
}

Status ComediStage::write(const StageCommand& command) {
    if (const auto why = guardian_->tripped())
        return failure(Reason::stopped, "the guardian switched the stage off: " + *why);
    guardian_->apply(command);
    return {};
}

}  // namespace fidservo::control::comedi
