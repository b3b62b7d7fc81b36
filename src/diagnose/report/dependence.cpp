// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/report/dependence.h"

#include "core/time.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace fidservo::diagnose {
namespace {

using gap::Signal;

/// What a row of a recording says of a quantity.
using OfRow = std::function<double(std::size_t run, std::size_t row)>;

std::vector<Sample> row_samples(const gap::Evidence& evidence, const Predictions& predictions, Signal signal,
                                const OfRow& quantity) {
    std::vector<Sample> samples;
    const std::vector<gap::Window>& windows = evidence.windows();
    for (std::size_t w = 0; w < windows.size(); ++w) {
        const gap::Window& window = windows[w];
        if (window.signal != signal) continue;
        for (std::size_t k = 0; k < window.rows; ++k) {
            const double x = quantity(window.run, window.first_row + k);
            const float before = predictions.nominal[window.begin + k],
                        after = predictions.explained[window.begin + k];
            if (std::isfinite(x) && !std::isnan(before) && !std::isnan(after))
                samples.push_back({static_cast<float>(x), before, after, static_cast<std::uint32_t>(w)});
        }
    }
    return samples;
}

/// The error along the motion, of each detection.
/// @param quantity  of a run's detection
std::vector<Sample> tag_samples(const gap::Evidence& evidence, const Predictions& predictions,
                                const OfRow& quantity) {
    std::vector<Sample> samples;
    const std::vector<gap::Window>& windows = evidence.windows();
    for (std::size_t w = 0; w < windows.size(); ++w) {
        const gap::Window& window = windows[w];
        if (window.signal != Signal::tag) continue;
        for (std::size_t k = window.begin; k < window.end; k += gap::corner_values) {
            const double x =
                quantity(window.run, window.first_detection + (k - window.begin) / gap::corner_values);
            if (std::isfinite(x) && !std::isnan(predictions.nominal[k]) &&
                !std::isnan(predictions.explained[k]))
                samples.push_back({static_cast<float>(x), predictions.nominal[k], predictions.explained[k],
                                   static_cast<std::uint32_t>(w)});
        }
    }
    return samples;
}

struct Sums {
    double errors = 0.0, count = 0.0;
};

/// @param error  of a sample
BinnedMean binned_mean(const std::vector<Sample>& samples, const std::vector<std::size_t>& bin_of,
                       std::size_t bins, float Sample::*error) {
    constexpr double fewest_values = 20.0;
    const std::size_t windows =
        samples.empty() ? 0 : std::size_t{std::ranges::max(samples, {}, &Sample::window).window} + 1;
    std::vector<Sums> by_window(bins * windows), by_bin(bins);
    double squares = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto value = static_cast<double>(samples[i].*error);
        for (Sums* sums : {&by_window[bin_of[i] * windows + samples[i].window], &by_bin[bin_of[i]]}) {
            sums->errors += value;
            sums->count += 1.0;
        }
        squares += value * value;
    }
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    BinnedMean result{std::vector<double>(bins, nan), std::vector<double>(bins, nan), 0.0};
    for (std::size_t bin = 0; bin < bins; ++bin) {
        const Sums& all = by_bin[bin];
        if (all.count < fewest_values) continue;
        const double mean = all.errors / all.count;
        result.mean[bin] = mean;
        result.share += all.errors * mean;
        double scatter = 0.0, parts = 0.0;
        for (std::size_t w = 0; w < windows; ++w) {
            const Sums& part = by_window[bin * windows + w];
            if (part.count == 0.0) continue;
            scatter += std::pow(part.errors - part.count * mean, 2);
            parts += 1.0;
        }
        if (parts > 1.0) result.std_error[bin] = std::sqrt(scatter * parts / (parts - 1.0)) / all.count;
    }
    result.share = squares > 0.0 ? result.share / squares : 0.0;
    return result;
}

/// The range of x without the outermost 0.2 % at each end; all of it where these are everything.
std::pair<float, float> usual_range(const std::vector<Sample>& samples) {
    constexpr double left_out = 0.002;
    if (samples.empty()) return {0.0f, 0.0f};
    std::vector<float> x(samples.size());
    std::ranges::transform(samples, x.begin(), &Sample::x);
    std::ranges::sort(x);
    const auto skipped = static_cast<std::size_t>(left_out * static_cast<double>(x.size()));
    const float low = x[skipped], high = x[x.size() - 1 - skipped];
    return high > low ? std::pair(low, high) : std::pair(x.front(), x.back());
}

}  // namespace

std::vector<Quantity> quantities(const gap::Evidence& evidence, const Predictions& predictions,
                                 Signal signal) {
    std::vector<Quantity> found;
    const auto add = [&](const char* name, const char* label, std::vector<Sample> samples) {
        const auto [low, high] = std::ranges::minmax_element(samples, {}, &Sample::x);
        if (samples.empty() || !(high->x > low->x)) return;
        found.push_back({name, label, std::move(samples)});
    };
    const auto of_course = [&](std::vector<float> gap::Course::*values) -> OfRow {
        return [&evidence, values](std::size_t run, std::size_t row) {
            return static_cast<double>((evidence.course(run).*values)[row]);
        };
    };
    const auto of_stage = [&](double StageRow::*value) -> OfRow {
        return [&evidence, value](std::size_t run, std::size_t row) {
            return evidence.recordings()[run].rows[row].*value;
        };
    };
    const OfRow time = [&](std::size_t run, std::size_t row) {
        const std::vector<StageRow>& rows = evidence.recordings()[run].rows;
        return seconds(rows[row].time_ns - rows.front().time_ns);
    };
    const OfRow position = of_course(&gap::Course::position_mm),
                velocity = of_course(&gap::Course::velocity_mm_per_s),
                temperature = of_course(&gap::Course::temperature_degC),
                contraction = of_course(&gap::Course::contraction_mm),
                macro_command = of_stage(&StageRow::macro_command_V),
                micro_command = of_stage(&StageRow::micro_command_V);
    const auto add_rows = [&](const char* name, const char* label, const OfRow& quantity) {
        add(name, label, row_samples(evidence, predictions, signal, quantity));
    };
    if (signal == Signal::encoder) {
        add_rows("velocity", "carriage velocity, mm/s", velocity);
        add_rows("position", "carriage position, mm", position);
        add_rows("command", "macro command, V", macro_command);
        add_rows("time", "time since the recording's start, s", time);
    } else if (signal == Signal::hall) {
        add_rows("temperature", "wire temperature by the rig file's heater, \u00b0C", temperature);
        add_rows("contraction", "platform position by the Hall reading, mm", contraction);
        add_rows("command", "heater command, V", micro_command);
        add_rows("macro command", "macro command, V", macro_command);
        add_rows("time", "time since the recording's start, s", time);
    } else if (signal == Signal::tag) {
        const auto at_row = [&](const OfRow& quantity) -> OfRow {
            return [&evidence, quantity](std::size_t run, std::size_t detection) {
                const Recording& recording = evidence.recordings()[run];
                return quantity(run, row_at(recording.rows, recording.detections[detection].time_ns));
            };
        };
        const auto add_tags = [&](const char* name, const char* label, const OfRow& quantity) {
            add(name, label, tag_samples(evidence, predictions, quantity));
        };
        add_tags("velocity", "carriage velocity, mm/s", at_row(velocity));
        add_tags("position", "carriage position, mm", at_row(position));
        add_tags("contraction", "platform position by the Hall reading, mm", at_row(contraction));
        add_tags("place in the image", "tag's place in the image, u, px",
                 [&](std::size_t run, std::size_t detection) {
                     Eigen::Vector2d sum = Eigen::Vector2d::Zero();
                     for (const Eigen::Vector2d& corner :
                          evidence.recordings()[run].detections[detection].corners_px)
                         sum += corner;
                     return sum.x() / 4.0;
                 });
        add_tags("time", "time since the recording's start, s", at_row(time));
    }
    return found;
}

BinnedErrors binned(const std::vector<Sample>& all, std::size_t bins) {
    BinnedErrors result;
    const auto [low, high] = usual_range(all);
    if (!(high > low)) return result;
    const auto from = static_cast<double>(low),
               width = (static_cast<double>(high) - from) / static_cast<double>(bins);
    std::vector<Sample> samples;
    std::vector<std::size_t> bin_of;
    for (const Sample& sample : all) {
        if (sample.x < low || sample.x > high) continue;
        samples.push_back(sample);
        bin_of.push_back(
            std::min(bins - 1, static_cast<std::size_t>((static_cast<double>(sample.x) - from) / width)));
    }
    for (std::size_t bin = 0; bin < bins; ++bin)
        result.x.push_back(from + (static_cast<double>(bin) + 0.5) * width);
    result.before = binned_mean(samples, bin_of, bins, &Sample::before);
    result.after = binned_mean(samples, bin_of, bins, &Sample::after);
    return result;
}

}  // namespace fidservo::diagnose
