#include "src/session/paced_stage.h"

#include <cerrno>
#include <ctime>

namespace fidservo {

namespace {

TimeNs now_ns() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * ns_per_s + now.tv_nsec;
}

void sleep_until(TimeNs time_ns) {
    const timespec until{time_ns / ns_per_s, time_ns % ns_per_s};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
}

}  // namespace

Result<control::StageSample> PacedStage::read() {
    auto sample = stage_->read();
    if (!sample) return sample;
    if (!start_ns_) start_ns_ = now_ns() - sample->time_ns;
    sample->time_ns += *start_ns_;
    sleep_until(sample->time_ns);
    return sample;
}

}  // namespace fidservo
