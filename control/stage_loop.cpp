// SPDX-License-Identifier: GPL-3.0-or-later
#include "control/stage_loop.h"

#include "control/guardian_process.h"
#include "core/demand.h"
#include "core/monotonic_clock.h"

#include <array>
#include <cerrno>
#include <cmath>
#include <ctime>
#include <limits>

#include <sys/mman.h>

namespace fidservo::control {

namespace {

constexpr double not_in_force = std::numeric_limits<double>::quiet_NaN();

void sleep_until(TimeNs time_ns) {
    const timespec until{time_ns / ns_per_s, time_ns % ns_per_s};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
}

/// Pages stay once they were touched, so that locking costs no memory that nobody uses.
bool lock_memory() {
    return ::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
}

/// Touches the stack that the loop may use, so that no tick has to wait for a page.
void touch_stack() {
    std::array<volatile char, 65536> room;
    for (std::size_t k = 0; k < room.size(); k += 1024) room[k] = 0;
}

void add_one(std::atomic<std::uint64_t>& counter) {
    counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

}  // namespace

struct StageLoop::Shared {
    std::array<std::atomic<std::uint64_t>, LatenessHistogram::fine_bins + LatenessHistogram::coarse_bins>
        lateness{};
    std::atomic<std::uint64_t> ticks{0}, overruns{0}, held{0};
    std::atomic<TimeNs> worst_ns{0};
    std::atomic<bool> real_time_priority{false};
    bool memory_locked = false;
};

StageLoop::StageLoop(std::shared_ptr<Stage> stage, const LoopOptions& options)
    : stage_(std::move(stage)),
      options_(options),
      ring_(static_cast<std::size_t>(std::ceil(options.ring_s / options.tick_s))),
      counters_(std::make_unique<Shared>()) {
    if (options_.watchdog) watchdog_ = watchdog_start(*options_.watchdog);
    counters_->memory_locked = lock_memory();
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

StageLoop::~StageLoop() {
    [[maybe_unused]] const Status off = stop();
}

Status StageLoop::stop() {
    if (thread_.joinable()) {
        thread_.request_stop();
        thread_.join();
    }
    return stage_->write({});
}

void StageLoop::start(const LoopProgram& program) {
    FIDSERVO_DEMAND(!running());
    wake_.clear();
    if (ended_.load(std::memory_order_acquire)) return;
    program_ = program;
    running_.store(true, std::memory_order_release);
    // The loop may have ended between the two; it no longer takes programs then.
    if (ended_.load(std::memory_order_seq_cst)) running_.store(false, std::memory_order_release);
}

void StageLoop::wait(std::chrono::milliseconds limit) const {
    if (running()) wake_.wait(limit.count() * ns_per_ms);
}

std::optional<TickRecord> StageLoop::next() {
    TickRecord record{};
    if (!ring_.pop(record)) return std::nullopt;
    return record;
}

std::optional<Failure> StageLoop::ended() const {
    if (!ended_.load(std::memory_order_acquire)) return std::nullopt;
    return why_;
}

void StageLoop::set_travel(const CarriageTravel& travel) {
    has_travel_.store(false, std::memory_order_release);
    low_count_.store(travel.low_count, std::memory_order_relaxed);
    high_count_.store(travel.high_count, std::memory_order_relaxed);
    has_travel_.store(true, std::memory_order_release);
}

LoopStatistics StageLoop::statistics() const {
    LoopStatistics now;
    now.ticks = counters_->ticks.load(std::memory_order_relaxed);
    now.overruns = counters_->overruns.load(std::memory_order_relaxed);
    now.held = counters_->held.load(std::memory_order_relaxed);
    for (std::size_t bin = 0; bin < now.lateness.counts.size(); ++bin)
        now.lateness.counts[bin] = counters_->lateness[bin].load(std::memory_order_relaxed);
    now.lateness.worst_ns = counters_->worst_ns.load(std::memory_order_relaxed);
    now.real_time_priority = counters_->real_time_priority.load(std::memory_order_relaxed);
    now.memory_locked = counters_->memory_locked;
    return now;
}

void StageLoop::run(const std::stop_token& stop) {
    counters_->real_time_priority.store(take_real_time_priority(), std::memory_order_relaxed);
    touch_stack();
    const TimeNs period_ns = nanoseconds(options_.tick_s);
    deadline_ns_ = monotonic_now_ns() + period_ns;
    while (!stop.stop_requested()) {
        const int ticks_late = wait_for_deadline(period_ns);
        if (!ended_.load(std::memory_order_relaxed) && !tick(ticks_late)) last_ = {};
        // A stage that has failed is still told to be off, at every tick.
        if (ended_.load(std::memory_order_relaxed)) [[maybe_unused]]
            const Status off = stage_->write({});
        deadline_ns_ += period_ns;
    }
}

/// The deadlines that have passed, to be skipped.
int StageLoop::skip_missed(TimeNs period_ns, TimeNs late_ns) {
    const int missed = static_cast<int>(std::min<TimeNs>(late_ns / period_ns, 1'000'000));
    deadline_ns_ += missed * period_ns;
    return missed;
}

int StageLoop::wait_for_deadline(TimeNs period_ns) {
    sleep_until(deadline_ns_);
    const TimeNs late_ns = monotonic_now_ns() - deadline_ns_;
    int left_out = skip_missed(period_ns, late_ns);
    if (left_out > 0) {
        ++left_out;
        deadline_ns_ += period_ns;
        sleep_until(deadline_ns_);
        left_out += skip_missed(period_ns, monotonic_now_ns() - deadline_ns_);
    }
    count(late_ns, left_out);
    return left_out;
}

void StageLoop::count(TimeNs late_ns, int ticks_late) {
    add_one(counters_->ticks);
    add_one(counters_->lateness[LatenessHistogram::bin_of(late_ns)]);
    for (int k = 0; k < ticks_late; ++k) add_one(counters_->overruns);
    if (late_ns > counters_->worst_ns.load(std::memory_order_relaxed))
        counters_->worst_ns.store(late_ns, std::memory_order_relaxed);
}

/// False if the loop has ended.
bool StageLoop::tick(int ticks_late) {
    auto sample = stage_->read();
    if (!sample) return end(std::move(sample.error())), false;
    sample->time_ns = deadline_ns_;
    if (options_.stop_requested != nullptr && options_.stop_requested())
        return end({Reason::stopped, "stopped by the user"}), false;
    bool held = false;
    if (options_.watchdog) {
        WatchdogInput input{*sample, last_, ticks_late, running_.load(std::memory_order_relaxed), {}};
        if (has_travel_.load(std::memory_order_acquire))
            input.travel = CarriageTravel{low_count_.load(std::memory_order_relaxed),
                                          high_count_.load(std::memory_order_relaxed)};
        const Alarm alarm = watchdog_update(*options_.watchdog, watchdog_, input);
        if (alarm != Alarm::none)
            return end({Reason::device, "motor and heater switched off: " +
                                            text_of(alarm, *options_.watchdog, watchdog_, input)}),
                   false;
    }
    const LoopStep step = decide(*sample, held);
    if (auto written = stage_->write(step.command); !written) return end(std::move(written.error())), false;
    last_ = step.command;
    if (!ring_.push({*sample, step, held}))
        return end({Reason::device,
                    "nobody took the loop's samples any more: motor and heater switched off"}),
               false;
    if (step.done) {
        running_.store(false, std::memory_order_release);
        wake_.raise();
    }
    return true;
}

LoopStep StageLoop::decide(const StageSample& sample, bool& held) {
    if (running_.load(std::memory_order_acquire)) return program_.tick(program_.self, sample);
    held = true;
    add_one(counters_->held);
    return {last_, not_in_force, not_in_force, false};
}

void StageLoop::end(Failure why) {
    [[maybe_unused]] const Status off = stage_->write({});
    why_ = std::move(why);
    ended_.store(true, std::memory_order_seq_cst);
    running_.store(false, std::memory_order_release);
    wake_.raise();
}

}  // namespace fidservo::control
