// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/rig.h"
#include "gap/balance/hat_functions.h"
#include "gap/candidates/coupling.h"
#include "gap/fit/counted_rows.h"
#include "gap/numbers.h"
#include "gap/residuals/surrogate.h"
#include "gap/residuals/wire_path.h"
#include "plant/effects/catalogue.h"
#include "plant/platform_swing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

namespace fidservo::gap {
namespace {

/// What a row offers to the functions below.
struct Row {
    double temperature_degC, contraction_mm, command_V, macro_command_V, carriage_mm_per_s2, time_s;
    double direction;  ///< of the temperature: -1 cooling, 1 heating
};

class PlatformColumns {
  public:
    explicit PlatformColumns(const Evidence& evidence)
        : evidence_(evidence),
          windows_(evidence.windows()),
          rows_(windows_, only_of(windows_, everything(evidence), only(Signal::hall))) {
        auto of_hall = rows_.windows().begin();
        for (Window& window : windows_)
            if (window.signal == Signal::hall) window = *of_hall++;
    }

    /// All windows, those of the Hall reading with their ranges among the values of columns, which are of
    /// this signal alone.
    const std::vector<Window>& windows() const { return windows_; }

    /// The Hall reading's among the errors of all signals.
    Errors own(const Errors& errors) const { return rows_.of(errors); }

    Row row(const Window& window, std::size_t k) const {
        const Course& course = evidence_.course(window.run);
        const Recording& recording = evidence_.recordings()[window.run];
        const std::size_t before = k >= glance_rows ? k - glance_rows : 0;
        const double tick_s = evidence_.rig().tick_s;
        const bool has_carriage = !course.velocity_mm_per_s.empty();
        return {course.temperature_degC[k],
                course.contraction_mm[k],
                recording.rows[k].micro_command_V,
                recording.rows[k].macro_command_V,
                has_carriage && k > 0
                    ? (course.velocity_mm_per_s[k] - course.velocity_mm_per_s[k - 1]) / tick_s
                    : 0.0,
                seconds(recording.rows[k].time_ns - recording.rows.front().time_ns),
                course.temperature_degC[k] < course.temperature_degC[before] ? -1.0 : 1.0};
    }

    Column of(Dependence group,
              const std::function<double(const Window&, std::size_t, const Row&)>& value) const {
        Column column{static_cast<int>(group), std::vector<float>(rows_.size(), 0.0F)};
        for (std::size_t w = 0; w < windows_.size(); ++w) {
            const Window& window = evidence_.windows()[w];
            if (window.signal != Signal::hall) continue;
            for (std::size_t k = 0; k < window.rows; ++k) {
                const double here = value(window, k, row(window, window.first_row + k));
                column.values[windows_[w].begin + k] = std::isfinite(here) ? static_cast<float>(here) : 0.0F;
            }
        }
        return column;
    }

    std::vector<float> all(const std::function<double(const Row&)>& quantity) const {
        constexpr std::size_t every = 11;
        std::vector<float> values;
        for (const Window& window : evidence_.windows()) {
            if (window.signal != Signal::hall) continue;
            for (std::size_t k = 0; k < window.rows; k += every) {
                const double value = quantity(row(window, window.first_row + k));
                if (std::isfinite(value)) values.push_back(static_cast<float>(value));
            }
        }
        return values;
    }

  private:
    const Evidence& evidence_;
    std::vector<Window> windows_;
    CountedRows rows_;
};

/// A small change of the wire, of whose tangents columns are multiples.
constexpr plant::Effect change_of_wire(void (*apply)(plant::PlantParameters& plant,
                                                     std::span<const double> values)) {
    return {.name = "",
            .block = "",
            .part = plant::Part::wire,
            .text = "",
            .source = "",
            .parameters = {},
            .apply = apply};
}
constexpr plant::Effect a_degree_warmer = change_of_wire(
    [](plant::PlantParameters& plant, std::span<const double>) { plant.micro->heater.ambient_degC += 1.0; });
constexpr plant::Effect a_hundredth_longer =
    change_of_wire([](plant::PlantParameters& plant, std::span<const double>) {
        plant.micro->stroke_factor *= 1.0 + hundredth;
    });
/// To so many hundredths of its heat.
template <int hundredths>
constexpr plant::Effect heated_by = change_of_wire([](plant::PlantParameters& plant,
                                                      std::span<const double>) {
    plant.micro->heater.gain_degC_per_V *= hundredth * hundredths;
});

/// What a change does to the errors.
Errors tangent(const Evidence& evidence, const plant::Effect& change) {
    const Wanted wanted = everything(evidence);
    Errors without = evidence.errors({}, wanted);
    const Errors with = evidence.errors({{&change, {}}}, wanted);
    for (std::size_t k = 0; k < without.size() && k < with.size(); ++k) without[k] = with[k] - without[k];
    return without;
}

std::vector<std::vector<float>> of_each_run(
    const Evidence& evidence, const std::function<std::vector<float>(std::size_t run)>& values) {
    std::vector<std::vector<float>> all;
    for (std::size_t run = 0; run < evidence.recordings().size(); ++run) all.push_back(values(run));
    return all;
}

/// What lies between the wire and the readings, whatever the temperature. With play between wire and platform
/// the platform stays where it is after each turn of the wire, for the same way at any temperature; a wire
/// that creeps follows itself with a lag, also where its end states are reached and warmth changes nothing.
void add_wire_paths(std::vector<Column>& columns, const PlatformColumns& make, const Evidence& evidence) {
    const auto wire_mm = of_each_run(evidence, [&](std::size_t run) { return wire_path_mm(evidence, run); });
    const auto add = [&](Dependence group, const std::function<std::vector<float>(std::size_t)>& changed) {
        const auto changed_mm = of_each_run(evidence, changed);
        columns.push_back(make.of(group, [&](const Window& window, std::size_t k, const Row&) {
            const std::size_t row = window.first_row + k;
            return changed_mm[window.run][row] - wire_mm[window.run][row];
        }));
    };
    constexpr std::array plays_mm{0.02, 0.05, 0.1, 0.2};
    constexpr std::array lags_s{0.5, 1.0, 2.0, 4.0, 8.0};
    for (const double play_mm : plays_mm)
        add(Dependence::turns_of_wire, [&](std::size_t run) { return behind_play(wire_mm[run], play_mm); });
    for (const double lag_s : lags_s)
        add(Dependence::contraction_before,
            [&](std::size_t run) { return behind_lag(wire_mm[run], lag_s, evidence.rig().tick_s); });
}

}  // namespace

Surrogate platform_surrogate(const Evidence& evidence, const Errors& errors) {
    const PlatformColumns make(evidence);
    Surrogate surrogate{Signal::hall, {}, {}, make.own(errors), make.windows()};
    std::vector<Column>& columns = surrogate.columns;
    const double tick_s = evidence.rig().tick_s;
    const Errors warmth = tangent(evidence, a_degree_warmer);
    const Errors stroke = tangent(evidence, a_hundredth_longer);
    const auto add_hats = [&](Dependence group, std::size_t count, const Errors* by,
                              const std::function<double(const Row&)>& quantity) {
        const std::vector<double> knots = knots_by_share(make.all(quantity), count);
        if (knots.size() < 2) return;
        for (std::size_t j = 0; j < knots.size(); ++j)
            columns.push_back(make.of(group, [&, j](const Window& window, std::size_t k, const Row& at) {
                return hat(knots, j, quantity(at)) * (by != nullptr ? (*by)[window.begin + k] : 1.0);
            }));
    };
    add_hats(Dependence::platform_place, platform_hats, nullptr,
             [](const Row& at) { return at.contraction_mm; });
    add_hats(Dependence::contraction, wire_hats, &stroke, [](const Row& at) { return at.time_s; });
    add_hats(Dependence::time, slow_hats, nullptr, [](const Row& at) { return at.time_s; });
    add_hats(Dependence::warmth_over_time, slow_hats, &warmth, [](const Row& at) { return at.time_s; });
    add_hats(Dependence::temperature, wire_hats, &warmth, [](const Row& at) { return at.temperature_degC; });
    // Where heat is far off, the wire ends up elsewhere on its loops than any slope says.
    constexpr int much_less = 75, less = 85, more = 115;
    const auto add_heated_by = [&](const plant::Effect& change, int hundredths) {
        constexpr double about_a_degree = 0.02;
        const Errors far_off = tangent(evidence, change);
        columns.push_back(
            make.of(Dependence::temperature, [&](const Window& window, std::size_t k, const Row&) {
                return about_a_degree / std::abs(hundredths / percent - 1.0) * far_off[window.begin + k];
            }));
    };
    add_heated_by(heated_by<much_less>, much_less);
    add_heated_by(heated_by<less>, less);
    add_heated_by(heated_by<more>, more);
    add_hats(Dependence::command, wire_hats, &warmth, [](const Row& at) { return at.command_V; });
    constexpr std::array memories_s{0.2, 0.6, 2.0, 6.0, 20.0};
    for (const double memory_s : memories_s) {
        const auto remembered = of_each_run(evidence, [&](std::size_t run) {
            return behind_lag(evidence.course(run).temperature_degC, memory_s, tick_s);
        });
        columns.push_back(
            make.of(Dependence::temperature_before, [&](const Window& window, std::size_t k, const Row& at) {
                return hundredth * (remembered[window.run][window.first_row + k] - at.temperature_degC) *
                       warmth[window.begin + k];
            }));
    }
    add_wire_paths(columns, make, evidence);
    columns.push_back(make.of(Dependence::direction, [&](const Window& window, std::size_t k, const Row& at) {
        return at.direction * warmth[window.begin + k];
    }));
    columns.push_back(make.of(Dependence::direction,
                              [](const Window&, std::size_t, const Row& at) { return at.direction; }));
    columns.push_back(make.of(Dependence::macro_command,
                              [](const Window&, std::size_t, const Row& at) { return at.macro_command_V; }));
    columns.push_back(make.of(Dependence::acceleration, [](const Window&, std::size_t, const Row& at) {
        return thousandth * at.carriage_mm_per_s2;
    }));
    constexpr double damping_ratio = 0.1;
    constexpr std::array frequencies_Hz{8.0, 12.0, 18.0, 27.0, 40.0, 60.0};
    for (const double frequency_Hz : frequencies_Hz)
        for (const bool of_velocity : {false, true}) {
            const auto swing =
                plant::make_platform_swing({frequency_Hz, damping_ratio, 1.0}, evidence.rig().tick_s);
            const double unit = 2.0 * std::numbers::pi * frequency_Hz *
                                (of_velocity ? 1.0 : 2.0 * std::numbers::pi * frequency_Hz);
            plant::SwingState state;
            columns.push_back(
                make.of(Dependence::acceleration, [&](const Window&, std::size_t k, const Row& at) {
                    if (k == 0) state = {};
                    plant::advance(swing, state, {.acceleration_mm_per_s2 = at.carriage_mm_per_s2});
                    return thousandth * unit * (of_velocity ? state.velocity_mm_per_s : state.position_mm);
                }));
        }
    return surrogate;
}

}  // namespace fidservo::gap
