// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/residuals/minor_loops.h"

#include "core/preisach.h"
#include "core/rig.h"
#include "gap/numbers.h"

#include <algorithm>
#include <cmath>

namespace fidservo::gap {
namespace {

enum class Loop { unknown, end_state, heated_from_cold, cooled_from_hot, minor };

/// Where on its loops the wire is, row after row.
class LoopFollower {
  public:
    explicit LoopFollower(double stroke_mm) : stroke_mm_(stroke_mm) {}

    Loop next(double temperature_degC, double contraction_mm) {
        constexpr double end_share = next_to_none, turn_degC = 0.5;
        if (std::isnan(temperature_degC) || std::isnan(contraction_mm)) return loop_ = Loop::unknown;
        const bool is_cold = contraction_mm < end_share * stroke_mm_;
        if (is_cold || contraction_mm > (1.0 - end_share) * stroke_mm_) {
            was_cold_ = is_cold;
            extreme_degC_ = temperature_degC;
            return loop_ = Loop::end_state;
        }
        if (loop_ == Loop::end_state) loop_ = was_cold_ ? Loop::heated_from_cold : Loop::cooled_from_hot;
        if (loop_ != Loop::heated_from_cold && loop_ != Loop::cooled_from_hot) return loop_;
        const double sign = was_cold_ ? 1.0 : -1.0;
        extreme_degC_ = sign * std::max(sign * extreme_degC_, sign * temperature_degC);
        if (sign * (extreme_degC_ - temperature_degC) > turn_degC) loop_ = Loop::minor;
        return loop_;
    }

  private:
    double stroke_mm_, extreme_degC_ = 0.0;
    bool was_cold_ = true;
    Loop loop_ = Loop::unknown;
};

struct MeanSquare {
    double sum = 0.0, rows = 0.0;
    void add(double error) {
        sum += error * error;
        rows += 1.0;
    }
    double value() const { return sum / rows; }
};

}  // namespace

bool only_minor_loops_are_off(const Evidence& evidence, const Errors& errors) {
    constexpr double fewest_rows = 500.0, least_excess = 0.1, far = 30.0;
    if (!evidence.rig().micro) return false;
    const double stroke_mm = evidence.rig().micro->fod->stroke_mm();
    std::vector<std::vector<Loop>> loops;
    for (std::size_t run = 0; run < evidence.recordings().size(); ++run) {
        const Course& course = evidence.course(run);
        LoopFollower follower(stroke_mm);
        loops.emplace_back();
        for (std::size_t k = 0; k < course.contraction_mm.size(); ++k)
            loops.back().push_back(follower.next(course.temperature_degC[k], course.contraction_mm[k]));
    }
    MeanSquare heated, cooled, minor;
    for (const Window& window : evidence.windows()) {
        if (window.signal != Signal::hall) continue;
        for (std::size_t k = 0; k < window.rows; ++k) {
            const double error = errors[window.begin + k];
            if (std::isnan(error)) continue;
            const Loop loop = loops[window.run][window.first_row + k];
            if (loop == Loop::heated_from_cold) heated.add(error);
            if (loop == Loop::cooled_from_hot) cooled.add(error);
            if (loop == Loop::minor) minor.add(error);
        }
    }
    if (std::min({heated.rows, cooled.rows, minor.rows}) < fewest_rows) return false;
    const double major_excess = std::max({heated.value() - 1.0, cooled.value() - 1.0, least_excess});
    return minor.value() - 1.0 > far * major_excess;
}

}  // namespace fidservo::gap
