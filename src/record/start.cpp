// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/record/start.h"

#include "core/micro_parameters.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace fidservo {

namespace {

constexpr double time_constants = 10.0;     ///< of cooling: 80 degC become 0.004
constexpr double most_drift_wait_s = 20.0;  ///< for readings that are not steady
constexpr double most_astray_mm = 0.5;      ///< of the carriage at the start

/// Whether readings drift: the means over two windows in turn, against what the noise leaves of them.
class DriftWatch {
  public:
    explicit DriftWatch(double tick_s) : ticks_(std::lround(window_s / tick_s)) {}

    /// One tick. True once two windows in turn agree.
    bool is_steady(double position_mm) {
        if (++count_ == 1) shift_mm_ = position_mm;
        const double value_mm = position_mm - shift_mm_;
        sum_ += value_mm;
        squares_ += value_mm * value_mm;
        if (count_ < ticks_) return steady_;
        const auto n = static_cast<double>(count_);
        const double mean_mm = shift_mm_ + sum_ / n;
        const double variance_mm2 = std::max(0.0, squares_ / n - (sum_ / n) * (sum_ / n));
        const double noise_mm = 3.0 * std::sqrt(2.0 * variance_mm2 / n);
        steady_ = last_mm_ && std::abs(mean_mm - *last_mm_) <= std::max(noise_mm, least_mm);
        last_mm_ = mean_mm;
        count_ = 0;
        sum_ = squares_ = 0.0;
        return steady_;
    }

  private:
    static constexpr double window_s = 0.5;
    static constexpr double least_mm = 0.0002;

    long ticks_, count_ = 0;
    double shift_mm_ = 0.0, sum_ = 0.0, squares_ = 0.0;
    std::optional<double> last_mm_;
    bool steady_ = false;
};

}  // namespace

double cooling_s(const Rig& rig) {
    return rig.micro ? time_constants * rig.micro->heater.cooling_tau_s : 0.0;
}

void ExperimentStart::heater_was_on() {
    heater_off_ns_ = pilot_.machine.now_ns();
    cold_ = false;
}

Result<std::string> ExperimentStart::cool() {
    if (cold_) return std::string();
    if (auto caught = pilot_.catch_up(); !caught) return forward(caught.error());
    const TimeNs cooled_ns = heater_off_ns_ + nanoseconds(cooling_s(pilot_.rig));
    const double rest_s = std::max(0.0, seconds(cooled_ns - pilot_.machine.now_ns()));
    DriftWatch drift(pilot_.rig.tick_s);
    long ticks_left = std::lround(rest_s / pilot_.rig.tick_s);
    const auto is_cold = [&] {
        const bool steady = drift.is_steady(pilot_.state.micro.position_mm);
        return --ticks_left < 0 && steady;
    };
    const auto waited = pilot_.step_until(is_cold, rest_s + most_drift_wait_s, "");
    cold_ = true;
    if (waited) return std::string();
    if (waited.error().reason != Reason::timeout) return forward(waited.error());
    return fmt::format("the Hall reading drifts, {:.0f} s after the heater was switched off",
                       seconds(pilot_.machine.now_ns() - heater_off_ns_));
}

Result<std::string> ExperimentStart::bring_to(double carriage_mm) {
    if (auto carried = pilot_.place_carriage(carriage_mm); !carried) return forward(carried.error());
    const double wrong_mm = pilot_.carriage_mm() - carriage_mm;
    if (std::abs(wrong_mm) > most_astray_mm)
        return failure(Reason::no_convergence,
                       fmt::format("sent to {:.2f} mm, the carriage stands {:.2f} mm from there", carriage_mm,
                                   wrong_mm));
    return cool();
}

}  // namespace fidservo
