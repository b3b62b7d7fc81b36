// SPDX-License-Identifier: GPL-3.0-or-later
// The carriage along a recording, against the closed form of a first-order motor beyond a dead zone:
//
//     tau dv/dt = K V - v,     V = sgn(u) (offset + slope (|u| - threshold)) for |u| >= threshold, else 0
#include "gap/links/carriage_link.h"

#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "tests/gap/effects.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

/// Forwards for 0.3 s, coasting to rest, and back, each second.
double command_V(std::size_t row) {
    const std::size_t phase = row % 1000;
    if (phase < 300) return 4.0;
    return phase >= 600 && phase < 900 ? -3.6 : 0.0;
}

/// Positions of a motor whose drive gives `gain` times the command, tick by tick, mm.
std::vector<double> closed_form_mm(const MacroParameters& macro, double gain, std::size_t rows) {
    const double tick_s = reference_rig().tick_s, tau_s = -tick_s / std::log(macro.velocity_pole);
    const DeadZone& zone = macro.dead_zone;
    std::vector<double> place_mm;
    double y_mm = 50.0, v_mm_per_s = 0.0;
    for (std::size_t k = 0; k < rows; ++k) {
        place_mm.push_back(y_mm);
        const double u = gain * command_V(k), size = std::abs(u);
        const double effective_V =
            size < zone.threshold_V
                ? 0.0
                : std::copysign(zone.offset_V + zone.slope * (size - zone.threshold_V), u);
        const double last_mm_per_s = macro.velocity_gain_mm_per_s_per_V * effective_V;
        const double decay = std::exp(-tick_s / tau_s);
        y_mm += last_mm_per_s * tick_s + tau_s * (v_mm_per_s - last_mm_per_s) * (1.0 - decay);
        v_mm_per_s = last_mm_per_s + (v_mm_per_s - last_mm_per_s) * decay;
    }
    return place_mm;
}

class CarriageLink : public ::testing::Test {
  protected:
    static constexpr std::size_t rows = 4200;

    CarriageRun run_of(double gain) {
        place_mm_ = closed_form_mm(macro_, gain, rows);
        Recording recording;
        recording.tick_s = reference_rig().tick_s;
        for (std::size_t k = 0; k < rows; ++k)
            recording.rows.push_back(
                {.time_ns = static_cast<TimeNs>(k) * ns_per_ms,
                 .macro_command_V = command_V(k),
                 .encoder_count = std::round(place_mm_[k] / macro_.encoder_resolution_mm)});
        return carriage_run(recording, macro_);
    }

    static CarriageModel model(std::initializer_list<std::string_view> truth) {
        plant::PlantParameters parameters = plant::plant_parameters(reference_rig());
        plant::apply_effects(parameters, testing::effects(truth));
        return carriage_model(parameters);
    }

    static std::size_t windows_of(const CarriageRun& run) {
        std::size_t count = 0;
        for (const std::vector<WindowRows>& stretch : run.windows) count += stretch.size();
        return count;
    }

    /// By how much predictions are off the closed form at most, counts.
    double most_off_count(const CarriageRun& run, const std::vector<double>& predicted) const {
        double most = 0.0;
        for (const std::vector<WindowRows>& stretch : run.windows)
            for (const WindowRows& window : stretch)
                for (std::size_t k = window.first; k < window.end; ++k)
                    most =
                        std::max(most, std::abs(predicted[k] - place_mm_[k] / macro_.encoder_resolution_mm));
        return most;
    }

    const MacroParameters& macro_ = reference_rig().macro;
    std::vector<double> place_mm_;
};

/// Each window begins from rounded counts, so that it may be off by what these leave open.
TEST_F(CarriageLink, OfTheTrueModel_IsTheClosedFormWithinACount) {
    const CarriageRun run = run_of(1.0);
    const std::vector<std::uint8_t> all(windows_of(run), 1);
    ASSERT_GE(all.size(), 4U);
    const PredictedCounts found = predicted_counts(model({}), run, all);
    ASSERT_EQ(found.counts.size(), rows);
    EXPECT_LT(most_off_count(run, found.counts), 1.0);
}

/// With the wrong gain a window's prediction is off by what the two ways differ by from its beginning on.
TEST_F(CarriageLink, OfAnotherGain_IsOffByTheDifferenceOfTheirWays_UnlessTheModelHasIt) {
    const CarriageRun run = run_of(0.9);
    const std::vector<std::uint8_t> all(windows_of(run), 1);
    EXPECT_LT(most_off_count(run, predicted_counts(model({"drive_gain:factor=0.9"}), run, all).counts), 1.0);
    const std::vector<double> nominal_mm = closed_form_mm(macro_, 1.0, rows);
    double most_mm = 0.0;
    for (const WindowRows& window : run.windows.front())
        for (std::size_t k = window.first; k < window.end; ++k)
            most_mm = std::max(most_mm, std::abs((nominal_mm[k] - nominal_mm[window.first]) -
                                                 (place_mm_[k] - place_mm_[window.first])));
    const double off_count = most_off_count(run, predicted_counts(model({}), run, all).counts);
    EXPECT_NEAR(off_count, most_mm / macro_.encoder_resolution_mm, 0.2 * off_count);
}

TEST_F(CarriageLink, WindowsThatAreNotWanted_CostNothing) {
    const CarriageRun run = run_of(1.0);
    std::vector<std::uint8_t> wanted(windows_of(run), 1);
    const CarriageModel truth = model({});
    const std::size_t all = predicted_counts(truth, run, wanted).effort;
    std::ranges::fill(wanted, std::uint8_t{0});
    EXPECT_EQ(predicted_counts(truth, run, wanted).effort, 0U);
    wanted.back() = 1;
    const std::size_t one = predicted_counts(truth, run, wanted).effort;
    EXPECT_GT(one, 0U);
    EXPECT_LT(one, all);
}

TEST_F(CarriageLink, ItsPath_IsTheClosedFormWithoutJumps) {
    const CarriageRun run = run_of(1.0);
    CarriagePath path = unknown_path(rows, Followed::motion);
    (void)predicted_counts(model({}), run, path);
    const auto fastest =
        std::ranges::max_element(path.velocity_mm_per_s, {}, [](double v) { return std::abs(v); });
    const double most_mm = std::abs(*fastest) * reference_rig().tick_s + 0.1 * macro_.encoder_resolution_mm;
    for (std::size_t k = 1; k < rows; ++k) {
        EXPECT_NEAR(path.position_mm[k], place_mm_[k], macro_.encoder_resolution_mm) << k;
        EXPECT_LT(std::abs(path.position_mm[k] - path.position_mm[k - 1]), most_mm) << k;
    }
}

}  // namespace
}  // namespace fidservo
