// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings drawn at random that contradict each other, that the model does not explain, or that determine
// only a ratio: every number stated has an interval that contains the truth, or is stated to be unknown.
#include "src/identify/identify.h"
#include "tests/effort.h"
#include "tests/identify/owned_recordings.h"
#include "tests/variations.h"

#include <functional>

namespace fidservo {
namespace {

using namespace testing;

/// in standard errors, scaled up where Student's distribution is wider than the normal one.
constexpr double far = 4.0;

const int tried = draws(200, 25);

double draw(std::mt19937_64& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

Carriage drawn_carriage(std::mt19937_64& random) {
    return {.gain_mm_per_s_per_V = draw(random, 20.0, 80.0),
            .time_constant_s = draw(random, 0.04, 0.2),
            .friction_V = draw(random, 0.1, 0.8),
            .offset_V = draw(random, -0.2, 0.2)};
}

using Truths = std::vector<std::pair<std::string, double>>;

/// Wrong: a number that is farther from its truth than four standard errors plus four times the stated bound
/// of the model's error, while no contradiction is named.
Outcome judged(const Identified& identified, const Truths& truths,
               const std::function<Identified()>& best_model = {}) {
    constexpr double normal_95 = 1.96;
    bool any = false;
    for (const auto& [key, truth] : truths) {
        const IdentifiedValue* value = find_value(identified, key);
        if (value == nullptr) continue;
        any = true;
        double reach = far * value->std;
        if (value->interval)
            reach = std::max(reach, far / normal_95 *
                                        std::max(value->interval->high - value->value,
                                                 value->value - value->interval->low));
        if (std::abs(value->value - truth) <= reach + far * value->systematic) continue;
        const bool warned = std::ranges::any_of(
            identified.contradictions, [&name = key](const Contradiction& of) { return of.key == name; });
        // Data without noise that the model follows as well may have another value: it is what is estimated.
        const IdentifiedValue* best = nullptr;
        Identified of_best;
        if (!warned && best_model) {
            of_best = best_model();
            best = find_value(of_best, key);
        }
        const bool known_to_be_unknown = best_model && best == nullptr && !of_best.undetermined.empty();
        if (best != nullptr && std::abs(value->value - best->value) <= reach + far * value->systematic)
            continue;
        if (!warned && !known_to_be_unknown)
            return Outcome::wrong(fmt::format("{}: {:.5g} +- {:.2g}, truth {:.5g}\n{}", key, value->value,
                                              value->std, truth, describe(identified)));
    }
    if (any) return Outcome::right();
    return identified.undetermined.empty() ? Outcome::wrong("nothing stated, nothing refused")
                                           : Outcome::refused(identified.undetermined.front().reason);
}

Outcome one_recording(const Carriage& carriage, std::mt19937_64& random,
                      const std::function<void(Recording&)>& spoil = {}, double duration_s = 3.6) {
    Recording recording = recorded(carriage, "drawn", drawn_pulses(random, duration_s), duration_s, random);
    if (spoil) spoil(recording);
    const auto without_noise = [&] {
        Recording longer = recorded(carriage, "longer", drawn_pulses(random, 4.0 * duration_s),
                                    4.0 * duration_s, random, 0.0);
        if (spoil) spoil(longer);
        return identify_macro({rig_of(carriage), {std::move(longer)}, std::nullopt, 0.0});
    };
    return judged(identify_macro({rig_of(carriage), {std::move(recording)}, std::nullopt, 0.0}),
                  truth_of(carriage), without_noise);
}

TEST(SlowOwnUpVariations, RecordingsThatContradictEachOther_AreOwnedUpTo) {
    expect_right_or_refused("identify macro: recordings that contradict", tried, [](std::mt19937_64& random) {
        constexpr double duration_s = 3.6;
        const Carriage common = drawn_carriage(random);
        const auto which = random() % 4, count = 2 + random() % 3;
        const double spread = draw(random, 0.0, 0.4);
        std::vector<Recording> recordings;
        std::vector<std::pair<std::string, double>> mean = truth_of(common);
        for (auto& [key, value] : mean) value = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            Carriage own = common;
            const double factor = 1.0 + spread * draw(random, -1.0, 1.0);
            if (which == 0) own.gain_mm_per_s_per_V *= factor;
            if (which == 1) own.time_constant_s *= factor;
            if (which == 2) own.friction_V *= factor;
            if (which == 3) own.offset_V += 0.2 * (factor - 1.0);
            recordings.push_back(recorded(own, fmt::format("recording-{}", i + 1),
                                          drawn_pulses(random, duration_s), duration_s, random));
            const auto truths = truth_of(own);
            for (std::size_t k = 0; k < mean.size(); ++k)
                mean[k].second += truths[k].second / static_cast<double>(count);
        }
        return judged(identify_macro({rig_of(common), std::move(recordings), std::nullopt, 0.0}), mean);
    });
}

TEST(SlowOwnUpVariations, ForcesThatTheModelLacks_AreOwnedUpTo) {
    expect_right_or_refused("identify macro: a force the model lacks", tried, [](std::mt19937_64& random) {
        Carriage carriage = drawn_carriage(random);
        const double size_V = draw(random, 0.05, 1.5);
        reference::Departures& other = carriage.other;
        switch (random() % 6) {
            case 0:
                other.mechanics.cogging_V = size_V;
                other.mechanics.cogging_period_mm = draw(random, 2.0, 20.0);
                break;
            case 1:
                other.mechanics.cable_V_per_mm = 0.05 * size_V;
                other.mechanics.cable_centre_mm = 0.0;
                break;
            case 2:
                other.friction.stribeck_V = size_V;
                other.friction.stribeck_speed_mm_per_s = draw(random, 5.0, 30.0);
                break;
            case 3:
                other.friction.viscous_backward = 1.0 + size_V;
                break;
            case 4:
                other.drive.delay_s = draw(random, 0.01, 0.08);
                break;
            default:
                other.friction.drag_V_s2_per_mm2 = size_V / 1e4;
                break;
        }
        return one_recording(carriage, random);
    });
}

TEST(SlowOwnUpVariations, SensorsAndColumnsThatAreWrong_AreOwnedUpTo) {
    expect_right_or_refused("identify macro: sensor or columns wrong", tried, [](std::mt19937_64& random) {
        const Carriage carriage = drawn_carriage(random);
        const auto kind = random() % 5;
        const double size = draw(random, 0.3, 1.0);
        return one_recording(carriage, random, [&](Recording& recording) {
            double low = 0.0, high = 0.0;
            for (const StageRow& row : recording.rows) {
                low = std::min(low, row.position_mm);
                high = std::max(high, row.position_mm);
            }
            for (StageRow& row : recording.rows) {
                if (kind == 0) row.position_mm = -row.position_mm;
                if (kind == 1) std::swap(row.position_mm, row.macro_command_V);
                if (kind == 2) row.position_mm = std::min(row.position_mm, low + size * (high - low));
                if (kind == 3) row.macro_command_V += draw(random, -2.0, 2.0) * size;
                if (kind == 4) row.macro_command_V = std::clamp(row.macro_command_V, -2.0 * size, 2.0 * size);
            }
        });
    });
}

/// Single steps: of steady speed or not, with a carriage that is held before the step or creeps.
TEST(SlowOwnUpVariations, ExcitationsThatFixARatioOnly_AreOwnedUpTo) {
    expect_right_or_refused("identify macro: ratio only", draws(1000, 75), [](std::mt19937_64& random) {
        Carriage carriage = drawn_carriage(random);
        carriage.time_constant_s = draw(random, 0.05, 3.0);
        carriage.friction_V = random() % 2 == 0 ? 0.0 : carriage.friction_V;
        const double step_V = draw(random, 1.5, 4.0), duration_s = draw(random, 0.2, 1.5);
        const Recording recording = recorded(
            carriage, "step", [=](double t_s) { return t_s < 0.05 ? 0.0 : step_V; }, duration_s, random);
        const Identified identified = identify_macro({rig_of(carriage), {recording}, std::nullopt, 0.0});
        auto truths = truth_of(carriage);
        // Driven to one side only, the offset is said to be taken as zero: friction is net of it.
        if (find_value(identified, "coulomb_friction") != nullptr)
            truths[2].second = carriage.friction_V - carriage.offset_V;
        // Said to be taken as zero: then the gain is that of the command less what friction and offset
        // take.
        const bool net_offset = std::ranges::any_of(identified.undetermined, [](const Undetermined& of) {
            return of.reason.find("drive offset less friction") != std::string::npos;
        });
        if (find_value(identified, "coulomb_friction") == nullptr && !net_offset)
            truths[0].second *= 1.0 - (carriage.friction_V - carriage.offset_V) / step_V;
        truths.emplace_back("gain_over_time_constant", truths[0].second / carriage.time_constant_s);
        return judged(identified, truths);
    });
}

TEST(SlowOwnUpVariations, FrictionAtItsBound_IsOwnedUpTo) {
    expect_right_or_refused("identify macro: friction at its bound", tried, [](std::mt19937_64& random) {
        Carriage carriage = drawn_carriage(random);
        carriage.friction_V = random() % 2 == 0 ? 0.0 : draw(random, 0.0, 0.02);
        return one_recording(carriage, random, {}, 2.4);
    });
}

}  // namespace
}  // namespace fidservo
