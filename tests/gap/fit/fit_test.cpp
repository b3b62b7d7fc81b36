// SPDX-License-Identifier: GPL-3.0-or-later
// Fits of hypotheses whose errors are known in closed form.
#include "gap/fit/fit.h"

#include "core/random.h"
#include "gap/fit/slopes.h"
#include "plant/effects/catalogue.h"
#include "tests/gap/equal_windows.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

constexpr std::size_t windows_count = 12, values = 300;

const std::vector<Window> windows = testing::equal_windows(windows_count, values);

/// Errors in proportion to the difference between drive_gain's factor and `truth`, plus noise of one floor.
Predict prediction(double truth, const std::vector<double>& noise) {
    return [truth, &noise](const Hypothesis& hypothesis) {
        Errors errors(windows_count * values);
        const double lacks = hypothesis.front().values.front() - truth;
        for (std::size_t k = 0; k < errors.size(); ++k)
            errors[k] =
                static_cast<float>(noise[k] + 1000.0 * lacks * std::sin(0.05 * static_cast<double>(k)));
        return errors;
    };
}

Fit fitted(double truth, std::uint64_t seed) {
    NoiseStream random(seed, "noise");
    std::vector<double> noise(windows_count * values);
    for (double& value : noise) value = random.normal();
    return fit(prediction(truth, noise), windows, Wanted(windows_count, 1),
               {plant::parse_effect("drive_gain:factor=1")}, {.tolerance = 1e-8, .with_covariance = true});
}

TEST(Fit, ValueComesBack_AndItsErrorIsThatOfManyNoises) {
    constexpr int draws = 60;
    double squares = 0.0;
    for (int seed = 1; seed <= draws; ++seed) {
        const Fit found = fitted(1.04, static_cast<std::uint64_t>(seed));
        const double error = found.hypothesis.front().values.front() - 1.04;
        EXPECT_LT(std::abs(error), 3e-4) << "seed " << seed;
        squares += error * error / found.covariance(0, 0);
    }
    EXPECT_GT(squares / draws, 0.6);  // 1 expected; 60 draws scatter by 0.18
    EXPECT_LT(squares / draws, 1.6);
}

TEST(Fit, ValueBeyondItsBound_EndsAtTheBound_WithoutAnError) {
    const Fit found = fitted(1.9, 1);
    EXPECT_EQ(found.hypothesis.front().values.front(), 1.5);
    EXPECT_EQ(found.covariance(0, 0), 0.0);
}

TEST(Fit, StepBeyondABound_IsCutThere_AndTheWayBackIsFound) {
    // From 0.9 on a linear step leads to 5.7, far beyond the bound of 1.5.
    const Predict bent = [](const Hypothesis& hypothesis) {
        Errors errors(windows_count * values);
        const double lacks = std::atan(20.0 * (hypothesis.front().values.front() - 1.3));
        for (std::size_t k = 0; k < errors.size(); ++k)
            errors[k] = static_cast<float>(lacks * std::sin(0.05 * static_cast<double>(k)));
        return errors;
    };
    const Fit found =
        fit(bent, windows, Wanted(windows_count, 1), {plant::parse_effect("drive_gain:factor=0.9")});
    EXPECT_NEAR(found.hypothesis.front().values.front(), 1.3, 1e-3);
}

/// A third of the windows is predicted best at a factor of 1, the others at 1.3.
Errors of_two_kinds(const Hypothesis& hypothesis) {
    Errors errors(windows_count * values);
    for (std::size_t k = 0; k < errors.size(); ++k) {
        const double truth = k / values < windows_count / 3 ? 1.0 : 1.3;
        const double lacks = hypothesis.front().values.front() - truth;
        errors[k] = static_cast<float>(100.0 * lacks * std::sin(0.05 * static_cast<double>(k)));
    }
    return errors;
}

TEST(Fit, FromAfar_FollowsMostWindows_NotThoseNearest) {
    const Hypothesis start{plant::parse_effect("drive_gain:factor=1")};
    const auto found = [&](double scale_floors) {
        return fit(of_two_kinds, windows, Wanted(windows_count, 1), start, {.scale_floors = scale_floors})
            .hypothesis.front()
            .values.front();
    };
    EXPECT_NEAR(found(1.0), 1.0, 0.01);
    EXPECT_NEAR(found(100.0), 1.2, 0.02);  // their mean
}

TEST(Fit, ExpectedSizes_BringBackWhatTheWindowsDoNotTell) {
    const Predict tells_nothing = [](const Hypothesis&) { return Errors(windows_count * values, 1.0F); };
    const Fit found = fit(tells_nothing, windows, Wanted(windows_count, 1),
                          {plant::parse_effect("drive_gain:factor=1.1")}, {.expected_sizes = 3.0});
    EXPECT_NEAR(found.hypothesis.front().values.front(), 1.0, 1e-4);
}

/// Errors that are slightly nonlinear in a gain and an offset. A hypothesis with the gain alone has no
/// offset.
Errors bent_a_little(const Hypothesis& hypothesis) {
    Errors errors(windows_count * values);
    const double gain = hypothesis[0].values[0] - 1.03, offset_V = hypothesis[1].values[0] - 0.05;
    for (std::size_t k = 0; k < errors.size(); ++k) {
        const double t = 0.05 * static_cast<double>(k);
        errors[k] = static_cast<float>(2e3 * gain * (1.0 + 3.0 * gain) * std::sin(t) +
                                       1e3 * offset_V * (1.0 + offset_V) * std::cos(0.3 * t));
    }
    return errors;
}

const Hypothesis gain_and_offset{plant::parse_effect("drive_gain:factor=1"),
                                 plant::parse_effect("drive_offset:offset_V=0")};

TEST(Fit, SlopesThatAreKept_LeadToTheSameValues_WithFewerPredictions) {
    const auto fit_counting = [](bool keeps_slopes, int& predictions) {
        std::atomic<int> count = 0;
        const Predict predict = [&](const Hypothesis& hypothesis) {
            ++count;
            return bent_a_little(hypothesis);
        };
        const Fit found = fit(predict, windows, Wanted(windows_count, 1), gain_and_offset,
                              {.most_iterations = 30, .tolerance = 1e-8, .keeps_slopes = keeps_slopes});
        predictions = count;
        return found.hypothesis;
    };
    int with_all = 0, with_some = 0;
    const Hypothesis all = fit_counting(false, with_all), some = fit_counting(true, with_some);
    for (const Hypothesis& found : {all, some}) {
        EXPECT_NEAR(found[0].values[0], 1.03, 1e-5);
        EXPECT_NEAR(found[1].values[0], 0.05, 1e-4);
    }
    EXPECT_LT(with_some, with_all);
}

TEST(MoveSlopes, PredictsTheChangeThatWasSeen_AndIsNotMisledByRounding) {
    const auto errors_at = [&](double gain, double offset_V) {
        Hypothesis hypothesis = gain_and_offset;
        hypothesis[0].values[0] = gain;
        hypothesis[1].values[0] = offset_V;
        return bent_a_little(hypothesis);
    };
    const std::vector<double> here{1.02, 0.03}, there{1.028, 0.034}, hardly_away{1.02 + 1e-9, 0.03};
    const Errors errors = errors_at(here[0], here[1]), errors_there = errors_at(there[0], there[1]);
    KnownSlopes known{here, errors, {errors, errors}};
    for (std::size_t row = 0; row < errors.size(); ++row) {
        known.by_parameter[0][row] = (errors_at(1.021, 0.03)[row] - errors[row]) / 1e-3F;
        known.by_parameter[1][row] = (errors_at(1.02, 0.031)[row] - errors[row]) / 1e-3F;
    }
    KnownSlopes moved = known;
    ASSERT_TRUE(move_slopes(moved, there, errors_there));
    EXPECT_EQ(moved.values, there);
    EXPECT_EQ(moved.errors, errors_there);
    for (std::size_t row = 0; row < errors.size(); ++row)
        EXPECT_NEAR(moved.by_parameter[0][row] * 0.008F + moved.by_parameter[1][row] * 0.004F,
                    errors_there[row] - errors[row], 1e-3);
    KnownSlopes same = known;
    ASSERT_TRUE(move_slopes(same, hardly_away, errors));
    EXPECT_EQ(same.by_parameter, known.by_parameter);
    Errors other = errors;
    for (float& error : other) error += 5.0F;
    EXPECT_FALSE(move_slopes(same, std::vector{1.0201, 0.03}, other));
    EXPECT_EQ(same.values, hardly_away);
    EXPECT_EQ(same.by_parameter, known.by_parameter);
}

// With a value at the start and none in a window, the least squares problem has an empty block.
TEST(Fit, WindowsWithoutAValue_GiveTheStartBack) {
    const Predict knows_nothing = [](const Hypothesis&) {
        return Errors(windows_count * values, std::numeric_limits<float>::quiet_NaN());
    };
    const Fit found =
        fit(knows_nothing, windows, Wanted(windows_count, 1), {plant::parse_effect("drive_gain:factor=1.1")});
    EXPECT_EQ(found.hypothesis.front().values.front(), 1.1);
    EXPECT_EQ(found.covariance, Eigen::MatrixXd::Zero(1, 1));
    EXPECT_EQ(found.curvature_covariance, Eigen::MatrixXd::Zero(1, 1));
}

TEST(Fit, RefusedHypothesis_IsGivenBackAsItIs) {
    const Predict refuses = [](const Hypothesis&) { return Errors{}; };
    const Fit found =
        fit(refuses, windows, Wanted(windows_count, 1), {plant::parse_effect("drive_gain:factor=1.1")});
    EXPECT_TRUE(std::isinf(found.loss));
    EXPECT_EQ(found.hypothesis.front().values.front(), 1.1);
}

}  // namespace

}  // namespace fidservo
