#include "src/session/paced_stage.h"

#include "core/monotonic_clock.h"

#include <cerrno>
#include <ctime>

namespace fidservo {

namespace {

void sleep_until(TimeNs time_ns) {
    const timespec until{time_ns / ns_per_s, time_ns % ns_per_s};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
}

}  // namespace

Result<control::StageSample> PacedStage::read() {
    auto sample = stage_->read();
    if (!sample) return sample;
    if (!start_ns_) start_ns_ = monotonic_now_ns() - sample->time_ns;
    sample->time_ns += *start_ns_;
    sleep_until(sample->time_ns);
    return sample;
}

}  // namespace fidservo
