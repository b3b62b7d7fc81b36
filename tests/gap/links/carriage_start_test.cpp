// SPDX-License-Identifier: GPL-3.0-or-later
// The correction of a carriage's state by counts, for errors that are known.
#include "gap/links/carriage_start.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

constexpr double ticks_per_tau = 60.0;
constexpr int ticks = 100;

/// Prediction minus count where the carried state was off by these, in counts.
std::vector<double> errors_of(double place_count, double coast_count) {
    std::vector<double> errors(ticks);
    for (int k = 0; k < ticks; ++k)
        errors[static_cast<std::size_t>(k)] =
            place_count + coast_count * (1.0 - std::exp(-k / ticks_per_tau));
    return errors;
}

/// The errors that a correction leaves.
std::vector<double> corrected(std::vector<double> errors, const StartCorrection& correction) {
    const std::vector<double> change = errors_of(correction.place_count, correction.coast_count);
    for (std::size_t k = 0; k < errors.size(); ++k) errors[k] += change[k];
    return errors;
}

TEST(CarriageStart, PredictionThatRoundsToEveryCount_IsNotCorrected) {
    const StartCorrection found = estimate_start(errors_of(0.4, 0.0), {}, ticks_per_tau);
    EXPECT_DOUBLE_EQ(found.place_count, 0.0);
    EXPECT_DOUBLE_EQ(found.coast_count, 0.0);
}

TEST(CarriageStart, PlaceThatIsOff_IsShiftedUntilItRoundsToTheCounts) {
    const std::vector<double> errors = errors_of(3.0, 0.0);
    for (const double left : corrected(errors, estimate_start(errors, {}, ticks_per_tau)))
        EXPECT_LT(std::abs(left), 0.6);
}

TEST(CarriageStart, VelocityThatIsOff_IsCorrectedByTheWayOverWhichItDecays) {
    const StartCorrection found = estimate_start(errors_of(0.0, 4.0), {}, ticks_per_tau);
    EXPECT_LT(found.coast_count, -2.5);
    EXPECT_LT(std::abs(found.place_count), 0.7);
}

/// Errors count from half a count on, where the loss has a corner in its slope.
TEST(CarriageStart, TheCorrectionIsWhereTheLossIsLeast) {
    const auto seed = std::random_device()();
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 draw(seed);
    std::uniform_real_distribution<double> place(-3.0, 3.0), coast(-4.0, 4.0), speed(-0.3, 0.3);
    for (int k = 0; k < 200; ++k) {
        std::vector<double> errors = errors_of(place(draw), coast(draw));
        const double count_per_tick = speed(draw);
        for (int tick = 0; tick < ticks; ++tick) {  // the count of a carriage that moves
            const double at = 0.3 + count_per_tick * tick;
            errors[static_cast<std::size_t>(tick)] += at - std::round(at);
        }
        const auto loss = [&](const StartCorrection& correction) {
            return start_loss(corrected(errors, correction), correction);
        };
        const StartCorrection best = estimate_start(errors, {}, ticks_per_tau);
        constexpr double hardly_less = 0.5;
        for (const double step : {-0.1, -0.02, 0.02, 0.1}) {
            EXPECT_GT(loss({best.place_count + step, best.coast_count}), loss(best) - hardly_less);
            EXPECT_GT(loss({best.place_count, best.coast_count + step}), loss(best) - hardly_less);
        }
    }
}

TEST(CarriageStart, WithACorrectionDone_TheSameOneIsFound) {
    const std::vector<double> errors = errors_of(3.0, 0.0), rest = errors_of(3.0 - 1.5, 0.0);
    const StartCorrection at_once = estimate_start(errors, {}, ticks_per_tau),
                          on = estimate_start(rest, {.place_count = -1.5}, ticks_per_tau);
    EXPECT_NEAR(on.place_count, at_once.place_count, 1e-3);
    EXPECT_NEAR(on.coast_count, at_once.coast_count, 1e-3);
}

TEST(CarriageStart, VelocityWhoseErrorsGrow_IsCorrectedByTheirSlopes) {
    std::vector<StartSlope> slopes;
    slopes.reserve(ticks);
    std::vector<double> errors;
    errors.reserve(ticks);
    for (int k = 0; k < ticks; ++k) {
        slopes.push_back({1.0, std::expm1(k / 30.0)});
        errors.push_back(-2.0 * slopes.back().per_coast);
    }
    const StartCorrection found = estimate_start(errors, {}, slopes);
    EXPECT_NEAR(found.coast_count, 2.0, 0.05);
    EXPECT_LT(std::abs(found.place_count), 0.5);
}

}  // namespace
}  // namespace fidservo
