#include "gap/hat_functions.h"
#include "gap/surrogate.h"
#include "plant/effects/catalogue.h"
#include "plant/platform_swing.h"

#include <cmath>
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

class Columns {
  public:
    explicit Columns(const Evidence& evidence) : evidence_(evidence) {
        for (const Window& window : evidence.windows())
            if (window.signal == Signal::hall) size_ = std::max(size_, window.end);
    }

    Row row(const Window& window, std::size_t k) const {
        constexpr std::size_t look_back = 20;
        const Course& course = evidence_.course(window.run);
        const Recording& recording = evidence_.recordings()[window.run];
        const std::size_t before = k >= look_back ? k - look_back : 0;
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
        Column column{static_cast<int>(group), std::vector<float>(size_, 0.0F)};
        for (const Window& window : evidence_.windows()) {
            if (window.signal != Signal::hall) continue;
            for (std::size_t k = 0; k < window.rows; ++k) {
                const double here = value(window, k, row(window, window.first_row + k));
                column.values[window.begin + k] = std::isfinite(here) ? static_cast<float>(here) : 0.0F;
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
    std::size_t size_ = 0;
};

/// What the wire's temperature was before, as far as a body of some time constant remembers it: of each
/// recording, row by row.
std::vector<std::vector<float>> remembered_degC(const Evidence& evidence, double memory_s) {
    const double share = -std::expm1(-evidence.rig().tick_s / memory_s);
    std::vector<std::vector<float>> of_run;
    for (std::size_t run = 0; run < evidence.recordings().size(); ++run) {
        std::vector<float> values = evidence.course(run).temperature_degC;
        double memory = values.empty() ? 0.0 : static_cast<double>(values.front());
        for (float& value : values) {
            if (std::isfinite(value)) memory += share * (static_cast<double>(value) - memory);
            value = static_cast<float>(memory);
        }
        of_run.push_back(std::move(values));
    }
    return of_run;
}

/// What a small effect does to the errors.
Errors tangent(const Evidence& evidence, std::string_view effect, double value) {
    const Wanted wanted = everything(evidence);
    Errors without = evidence.errors({}, wanted);
    const Errors with = evidence.errors({{plant::find_effect(effect), {value}}}, wanted);
    for (std::size_t k = 0; k < without.size() && k < with.size(); ++k) without[k] = with[k] - without[k];
    return without;
}

}  // namespace

Surrogate platform_surrogate(const Evidence& evidence) {
    const Columns make(evidence);
    Surrogate surrogate{Signal::hall, {}, {}};
    std::vector<Column>& columns = surrogate.columns;
    const Errors warmth = tangent(evidence, "ambient_temperature", 1.0);
    const Errors stroke = tangent(evidence, "stroke_change", 1.01);
    const auto add_hats = [&](Dependence group, std::size_t count, const Errors* by,
                              const std::function<double(const Row&)>& quantity) {
        const std::vector<double> knots = knots_by_share(make.all(quantity), count);
        if (knots.size() < 2) return;
        for (std::size_t j = 0; j < knots.size(); ++j)
            columns.push_back(make.of(group, [&, j](const Window& window, std::size_t k, const Row& at) {
                return hat(knots, j, quantity(at)) * (by != nullptr ? (*by)[window.begin + k] : 1.0);
            }));
    };
    add_hats(Dependence::contraction, 10, nullptr, [](const Row& at) { return at.contraction_mm; });
    add_hats(Dependence::contraction, 5, &stroke, [](const Row& at) { return at.contraction_mm; });
    add_hats(Dependence::time, 6, nullptr, [](const Row& at) { return at.time_s; });
    add_hats(Dependence::temperature, 8, &warmth, [](const Row& at) { return at.temperature_degC; });
    add_hats(Dependence::command, 8, &warmth, [](const Row& at) { return at.command_V; });
    for (const double memory_s : {0.2, 0.6, 2.0, 6.0, 20.0}) {
        const auto remembered = remembered_degC(evidence, memory_s);
        columns.push_back(
            make.of(Dependence::temperature_before, [&](const Window& window, std::size_t k, const Row& at) {
                return 1e-2 * (remembered[window.run][window.first_row + k] - at.temperature_degC) *
                       warmth[window.begin + k];
            }));
    }
    columns.push_back(make.of(Dependence::direction, [&](const Window& window, std::size_t k, const Row& at) {
        return at.direction * warmth[window.begin + k];
    }));
    columns.push_back(make.of(Dependence::direction,
                              [](const Window&, std::size_t, const Row& at) { return at.direction; }));
    columns.push_back(make.of(Dependence::macro_command,
                              [](const Window&, std::size_t, const Row& at) { return at.macro_command_V; }));
    columns.push_back(make.of(Dependence::acceleration, [](const Window&, std::size_t, const Row& at) {
        return 1e-3 * at.carriage_mm_per_s2;
    }));
    constexpr double damping_ratio = 0.1;
    for (const double frequency_Hz : {8.0, 12.0, 18.0, 27.0, 40.0, 60.0})
        for (const bool of_velocity : {false, true}) {
            const auto swing =
                plant::make_platform_swing({frequency_Hz, damping_ratio, 1.0}, evidence.rig().tick_s);
            const double unit = 2.0 * std::numbers::pi * frequency_Hz *
                                (of_velocity ? 1.0 : 2.0 * std::numbers::pi * frequency_Hz);
            plant::SwingState state;
            columns.push_back(
                make.of(Dependence::acceleration, [&](const Window&, std::size_t k, const Row& at) {
                    if (k == 0) state = {};
                    plant::advance(swing, state, at.carriage_mm_per_s2);
                    return 1e-3 * unit * (of_velocity ? state.velocity_mm_per_s : state.position_mm);
                }));
        }
    return surrogate;
}

}  // namespace fidservo::gap
