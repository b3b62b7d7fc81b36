// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/balance/carriage_forces.h"

#include "core/dead_zone.h"
#include "core/rig.h"
#include "gap/links/carriage_run.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Dense>

namespace fidservo::gap {
namespace {

constexpr std::size_t half_smoothing = 8;  ///< rows
constexpr double sliding_mm_per_s = 2.0;   ///< three standard deviations of the smoothed velocity

/// Mathematics: phi = c (1 - s^2)^4, s = t / h, of integral 1.
double modulating(double s, double h_s) {
    return 315.0 / (256.0 * h_s) * std::pow(std::max(0.0, 1.0 - s * s), 4);
}

/// Place, velocity and half the acceleration, per rows, in the middle of a parabola through readings.
class Smoothing {
  public:
    Smoothing() {
        constexpr auto rows = static_cast<Eigen::Index>(2 * half_smoothing + 1);
        Eigen::Matrix<double, rows, 3> powers;
        for (Eigen::Index k = 0; k < rows; ++k) {
            const double x = static_cast<double>(k) - static_cast<double>(half_smoothing);
            powers.row(k) << 1.0, x, x * x;
        }
        weights_ = (powers.transpose() * powers).ldlt().solve(powers.transpose());
    }

    Eigen::Vector3d at(const double* middle) const {
        return weights_ * Eigen::Map<const Eigen::VectorXd>(middle - half_smoothing, weights_.cols());
    }

  private:
    Eigen::Matrix<double, 3, Eigen::Dynamic> weights_;
};

SlidingRow row_of(const Evidence& evidence, std::size_t run, std::size_t row, double reading_mm,
                  const Eigen::Vector3d& smooth) {
    const std::vector<StageRow>& rows = evidence.recordings()[run].rows;
    const double tick_s = evidence.rig().tick_s, velocity = smooth(1) / tick_s;
    const double command_V = rows[row].macro_command_V;
    const DeadZone& zone = evidence.rig().macro.dead_zone;
    const bool pushes = dead_zone_branch(zone, command_V) != DeadZoneBranch::inside;
    return {reading_mm,
            smooth(0),
            velocity,
            2.0 * smooth(2) / (tick_s * tick_s),
            std::copysign(1.0, velocity),
            command_V,
            pushes ? zone.slope : 0.0,
            seconds(rows[row].time_ns - rows.front().time_ns),
            run,
            row};
}

/// A reading that is further off than the rail is long is none.
bool is_free(const MacroParameters& macro, double position_mm, double error_mm) {
    const double predicted_mm = position_mm + error_mm;
    return std::abs(error_mm) < macro.high_mm - macro.low_mm &&
           predicted_mm > macro.low_mm + macro.encoder_resolution_mm &&
           predicted_mm < macro.high_mm - macro.encoder_resolution_mm;
}

/// Whether no row is missing among those that are smoothed over.
bool is_without_break(const std::vector<StageRow>& rows, std::size_t row, double tick_s) {
    const double ticks = static_cast<double>(2 * half_smoothing) + 0.5;
    return seconds(rows[row + half_smoothing].time_ns - rows[row - half_smoothing].time_ns) < ticks * tick_s;
}

bool slides(const MacroParameters& macro, const SlidingRow& row, double edge_V) {
    const DeadZoneBranch branch = dead_zone_branch(macro.dead_zone, row.command_V);
    return std::abs(row.velocity_mm_per_s) > sliding_mm_per_s &&
           std::abs(dead_zone_slack_V(macro.dead_zone, branch, row.command_V)) > edge_V;
}

}  // namespace

CarriageForces::CarriageForces(const Evidence& evidence, const Errors& errors, std::size_t half_support,
                               double edge_V)
    : budget_(evidence.budget()) {
    const MacroParameters& macro = evidence.rig().macro;
    const double floor_mm = evidence.floor(Signal::encoder) * macro.encoder_resolution_mm;
    find_weights(evidence.rig(), floor_mm, half_support);
    std::vector<std::vector<double>> of_run;
    for (const Recording& recording : evidence.recordings()) of_run.push_back(readings_mm(recording, macro));
    const Smoothing smoothing;
    const std::size_t support_rows = 2 * half_support + 1, every = half_support / 2;
    for (const Window& window : evidence.windows()) {
        Window& of_supports = windows_.emplace_back(window);
        of_supports.begin = of_supports.end = supports_.size();
        if (window.signal != Signal::encoder) continue;
        std::size_t sliding = 0;  // rows without a break, up to this one
        for (std::size_t k = 0; k < window.rows; ++k) {
            const std::size_t row = window.first_row + k;
            const std::vector<double>& reading_mm = of_run[window.run];
            if (row < half_smoothing || row + half_smoothing >= reading_mm.size()) continue;
            const float error = errors[window.begin + k];
            const Eigen::Vector3d smooth = smoothing.at(&reading_mm[row]);
            const SlidingRow here = row_of(evidence, window.run, row, reading_mm[row], smooth);
            if (!is_without_break(evidence.recordings()[window.run].rows, row, evidence.rig().tick_s) ||
                !is_free(macro, here.position_mm, floor_mm * static_cast<double>(error)) ||
                !slides(macro, here, edge_V)) {
                sliding = 0;
                continue;
            }
            if (sliding > 0 && rows_.back().direction != here.direction) sliding = 0;
            rows_.push_back(here);
            if (++sliding < support_rows || (sliding - support_rows) % every != 0) continue;
            const std::size_t first = window.begin + k + 1 - support_rows;
            double sum = 0.0;
            for (std::size_t i = 0; i < support_rows; ++i)
                sum += of_reading_[i] * static_cast<double>(errors[first + i]);
            supports_.push_back(rows_.size() - support_rows);
            lacking_.push_back(static_cast<float>(sum * floor_mm));
            of_supports.end = lacking_.size();
        }
    }
}

void CarriageForces::find_weights(const Rig& rig, double floor_mm, std::size_t half_support) {
    const double tau_s = time_constant_s(rig.macro, rig.tick_s);
    const double tick_s = rig.tick_s, h_s = static_cast<double>(half_support) * tick_s;
    const auto phi = [&](double ticks) { return modulating(ticks * tick_s / h_s, h_s); };
    double variance = 0.0;
    for (std::size_t i = 0; i < 2 * half_support + 1; ++i) {
        const double ticks = static_cast<double>(i) - static_cast<double>(half_support);
        // Differences: however few the rows are, an error that is constant or grows evenly has no part in
        // the second one, which stands for a large number.
        const double first = (phi(ticks + 1.0) - phi(ticks - 1.0)) / (2.0 * tick_s);
        const double second = (phi(ticks + 1.0) - 2.0 * phi(ticks) + phi(ticks - 1.0)) / (tick_s * tick_s);
        of_velocity_.push_back(-tick_s * first);
        of_acceleration_.push_back(tick_s * second);
        of_reading_.push_back((tau_s * of_acceleration_.back() + of_velocity_.back()) /
                              rig.macro.velocity_gain_mm_per_s_per_V);
        // A command acts from its row to the next.
        of_force_.push_back(tick_s * phi(ticks + 0.5));
        variance += std::pow(floor_mm * of_reading_.back(), 2);
    }
    for (std::vector<double>* weights : {&of_reading_, &of_force_, &of_velocity_, &of_acceleration_})
        for (double& weight : *weights) weight /= std::sqrt(variance);
}

Column CarriageForces::column(int group, const std::vector<double>& weights,
                              const std::function<double(const SlidingRow&)>& quantity) const {
    budget_->check();
    std::vector<double> values(rows_.size());
    std::ranges::transform(rows_, values.begin(), quantity);
    Column column{group, {}};
    column.values.reserve(supports_.size());
    for (const std::size_t first_row : supports_)
        column.values.push_back(static_cast<float>(std::inner_product(
            weights.begin(), weights.end(), values.begin() + static_cast<std::ptrdiff_t>(first_row), 0.0)));
    return column;
}

Column CarriageForces::of_force(int group, const std::function<double(const SlidingRow&)>& force_V) const {
    return column(group, of_force_, force_V);
}

Column CarriageForces::of_reading(int group, const std::function<double(const SlidingRow&)>& error_mm) const {
    return column(group, of_reading_, error_mm);
}

double CarriageForces::deviation_of(double V_per_mm_per_s2, double V_per_mm_per_s) const {
    const auto square = [](const std::vector<double>& weights) {
        return std::inner_product(weights.begin(), weights.end(), weights.begin(), 0.0);
    };
    // One is even, the other odd.
    return std::sqrt((V_per_mm_per_s2 * V_per_mm_per_s2 * square(of_acceleration_) +
                      V_per_mm_per_s * V_per_mm_per_s * square(of_velocity_)) /
                     square(of_reading_));
}

std::vector<float> CarriageForces::values(const std::function<double(const SlidingRow&)>& quantity) const {
    constexpr std::size_t step = 7;
    std::vector<float> found;
    for (std::size_t k = 0; k < rows_.size(); k += step)
        found.push_back(static_cast<float>(quantity(rows_[k])));
    return found;
}

std::vector<double> support_weights(std::span<const Window> windows, const Errors& values) {
    std::vector<double> weights(values.size());
    for (const Window& window : windows) {
        double squares = 0.0;
        for (std::size_t k = window.begin; k < window.end; ++k)
            squares += static_cast<double>(values[k]) * values[k];
        const auto count = static_cast<double>(window.end - window.begin);
        std::fill(weights.begin() + static_cast<std::ptrdiff_t>(window.begin),
                  weights.begin() + static_cast<std::ptrdiff_t>(window.end),
                  1.0 / std::sqrt(count + squares));
    }
    return weights;
}

}  // namespace fidservo::gap
