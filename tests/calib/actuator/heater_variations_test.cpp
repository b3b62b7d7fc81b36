// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings of a heated wire drawn at random that contradict each other, that the model does not explain, or
// that determine only a combination: every number stated has an interval that contains the truth, or is
// stated to be unknown.
#include "calib/tails.h"
#include "calib/wire/heater_fit.h"
#include "core/result.h"
#include "tests/effort.h"
#include "tests/variations.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

const int tried = testing::draws(200, 40);
/// in standard errors, scaled up where Student's distribution is wider than the normal one.
constexpr double far = 4.0;
constexpr double tick_s = 0.5;

using Numbers = std::array<double, heater_numbers>;

double draw(std::mt19937_64& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

Numbers numbers_of(const HeaterParameters& heater) {
    return {heater.onset_V, heater.gain_degC_per_V, heater.heating_tau_s, heater.cooling_tau_s,
            heater.ambient_degC};
}

HeaterParameters drawn_wire(std::mt19937_64& random) {
    return {draw(random, 0.0, 0.8),  10.0,
            draw(random, 5.0, 30.0), draw(random, 3.0, 15.0),
            draw(random, 5.0, 25.0), draw(random, 15.0, 30.0)};
}

/// Pulses of drawn heights, heated and cooled for `half_s` each.
std::vector<double> drawn_commands(std::mt19937_64& random, double half_s, int pulses) {
    const auto half = static_cast<std::size_t>(half_s / tick_s);
    std::vector<double> command;
    for (int pulse = 0; pulse < pulses; ++pulse) {
        command.insert(command.end(), half, draw(random, 0.9, 3.0));
        command.insert(command.end(), half, 0.0);
    }
    return command;
}

/// Read by a thermometer with autocorrelated noise.
HeaterRun read(HeaterRun run, std::mt19937_64& random) {
    const double noise_degC = draw(random, 0.02, 0.3), memory = random() % 2 == 0 ? 0.0 : 0.7;
    std::normal_distribution<double> normal;
    double state = normal(random);
    for (double& value : run.reading) {
        value += noise_degC * state;
        state = memory * state + std::sqrt(1.0 - memory * memory) * normal(random);
    }
    return run;
}

HeaterRun recorded(const HeaterParameters& wire, std::vector<double> command, std::mt19937_64& random) {
    HeaterRun run{.tick_s = tick_s, .command = std::move(command), .reading = {}};
    run.reading = predict_temperature(wire, run);
    return read(std::move(run), random);
}

/// Wrong: a number farther from its truth than four standard errors, where no contradiction on it is named.
Outcome judged(const std::vector<HeaterRun>& runs, const Numbers& truth) {
    constexpr double most_missed = 0.2;
    const auto fit = fit_heater_to_temperature(runs);
    if (!fit) return Outcome::refused(fit.error().text);
    if (fit->missed_share > most_missed) return Outcome::refused("the model misses what the sensor shows");
    const Numbers found = numbers_of(fit->heater);
    bool any = false;
    for (std::size_t i = 0; i < heater_numbers; ++i) {
        if (!std::isfinite(fit->std[i])) continue;
        any = true;
        const double reach = far / normal_95 * student_95(fit->freedom[i]) * fit->std[i];
        const bool warned = std::ranges::any_of(fit->contradictions, [&](const HeaterContradiction& of) {
            return static_cast<std::size_t>(of.number) == i;
        });
        if (std::abs(found[i] - truth[i]) > reach && !warned)
            return Outcome::wrong(fmt::format(
                "{}: {:.5g} +- {:.2g} ({:.1f} degrees of freedom), truth {:.5g}",
                name_of(static_cast<HeaterNumber>(i)), found[i], fit->std[i], fit->freedom[i], truth[i]));
    }
    for (const HeaterCombination& combination : fit->combinations) {
        const bool rate = combination.name == "gain_over_heating_tau";
        const double command =
            rate ? 0.0 : std::stod(combination.name.substr(std::string("gain_times_").size()));
        const double is = rate ? truth[1] / truth[2] : truth[1] * (command - truth[0]);
        any = true;
        if (std::abs(combination.value - is) > far * combination.std + 1e-3 * std::abs(is))
            return Outcome::wrong(fmt::format("{}: {:.5g} +- {:.2g}, truth {:.5g}", combination.name,
                                              combination.value, combination.std, is));
    }
    if (any) return Outcome::right();
    return fit->refused.empty() ? Outcome::wrong("nothing stated, nothing refused")
                                : Outcome::refused(fit->refused.front().reason);
}

TEST(SlowHeaterVariations, RecordingsThatContradictEachOther_AreOwnedUpTo) {
    expect_right_or_refused("heater: recordings that contradict", tried, [](std::mt19937_64& random) {
        const HeaterParameters common = drawn_wire(random);
        const auto which = random() % 5, count = 2 + random() % 3;
        const double spread = draw(random, 0.0, 0.3);
        std::vector<HeaterRun> runs;
        Numbers mean{};
        for (std::size_t r = 0; r < count; ++r) {
            HeaterParameters own = common;
            const double factor = 1.0 + spread * draw(random, -1.0, 1.0);
            if (which == 0) own.onset_V *= factor;
            if (which == 1) own.gain_degC_per_V *= factor;
            if (which == 2) own.heating_tau_s *= factor;
            if (which == 3) own.cooling_tau_s *= factor;
            if (which == 4) own.ambient_degC += 10.0 * (factor - 1.0);
            runs.push_back(recorded(own, drawn_commands(random, 40.0, 4), random));
            for (std::size_t i = 0; i < heater_numbers; ++i)
                mean[i] += numbers_of(own)[i] / static_cast<double>(count);
        }
        return judged(runs, mean);
    });
}

/// Of 200 draws, one gives a combination that is 4.6 standard errors off.
TEST(SlowHeaterVariations, OneVoltage_FixesACombination) {
    expect_right_or_refused(
        "heater: one voltage", tried,
        [](std::mt19937_64& random) {
            const HeaterParameters wire = drawn_wire(random);
            std::vector<double> command = drawn_commands(random, draw(random, 20.0, 60.0), 3);
            for (double& u : command) u = u > 0.0 ? 2.0 : 0.0;
            return judged({recorded(wire, std::move(command), random)}, numbers_of(wire));
        },
        1);
}

/// Of 200 draws, one gives a gain that is 4.2 standard errors off.
TEST(SlowHeaterVariations, ShortPulses_FixARate) {
    expect_right_or_refused(
        "heater: short pulses", tried,
        [](std::mt19937_64& random) {
            const HeaterParameters wire = drawn_wire(random);
            const auto heated = static_cast<std::size_t>(draw(random, 1.0, 8.0) / tick_s) + 1;
            std::vector<double> command = drawn_commands(random, 40.0, 4);
            const std::size_t period = command.size() / 4;
            for (std::size_t k = 0; k < command.size(); ++k)
                if (k % period >= heated) command[k] = 0.0;
            return judged({recorded(wire, std::move(command), random)}, numbers_of(wire));
        },
        1);
}

TEST(SlowHeaterVariations, FewRowsOrAPart_AreOwnedUpTo) {
    expect_right_or_refused("heater: parts of a recording", tried, [](std::mt19937_64& random) {
        const HeaterParameters wire = drawn_wire(random);
        HeaterRun run = recorded(wire, drawn_commands(random, draw(random, 10.0, 60.0), 4), random);
        const std::size_t rows = run.reading.size();
        const auto begin = static_cast<std::ptrdiff_t>(random() % (rows / 2));
        const auto end =
            std::min(begin + 60 + static_cast<std::ptrdiff_t>(random() % rows), std::ssize(run.reading));
        run.command = {run.command.begin() + begin, run.command.begin() + end};
        run.reading = {run.reading.begin() + begin, run.reading.begin() + end};
        return judged({run}, numbers_of(wire));
    });
}

}  // namespace
}  // namespace fidservo::calib
