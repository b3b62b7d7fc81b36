// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/starts/shape_screening.h"

#include "plant/effects/catalogue.h"
#include "tests/gap/equal_windows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

constexpr std::size_t windows = 30, values = 20;

/// What an effect adds to an error, of one typical size.
double wave_of(const plant::EffectSetting& setting, std::size_t k) {
    const double t = static_cast<double>(k) / values;
    if (setting.effect->name == "hall_offset") return 1.0;
    return std::exp(-t / setting.values[1]);  // slower or faster, by a shape
}

double typical_sizes(const plant::EffectSetting& setting) {
    const plant::EffectParameter& size = setting.effect->parameters[0];
    return (setting.values[0] - size.vanishing) / (size.typical - size.vanishing);
}

/// Errors that are linear in sizes: of a recording that an effect of some shape and size has made.
Errors errors_of(const Hypothesis& hypothesis, const plant::EffectSetting& truth, double offset) {
    Errors errors(windows * values);
    for (std::size_t k = 0; k < errors.size(); ++k) {
        double error = offset - typical_sizes(truth) * wave_of(truth, k);
        for (const plant::EffectSetting& setting : hypothesis)
            error += typical_sizes(setting) * wave_of(setting, k);
        errors[k] = static_cast<float>(error);
    }
    return errors;
}

Candidate candidate_of(std::string_view name, std::vector<std::vector<double>> shapes) {
    return {.effect = plant::find_effect(name),
            .sizes = {0},
            .shapes = std::move(shapes),
            .wave = {},
            .patch = {},
            .class_name = std::string(name)};
}

TEST(ShapeScreening, FindsTheShapeAndTheSize_ThatAreThere_BesideWhatElseMayChange) {
    const plant::Effect& mass = *plant::find_effect("second_thermal_mass");
    std::vector<double> typical;
    for (const plant::EffectParameter& parameter : mass.parameters) typical.push_back(parameter.typical);
    std::vector<std::vector<double>> shapes;
    for (const double tau_s : {2.0, 8.0, 30.0}) {
        shapes.push_back(typical);
        shapes.back()[1] = tau_s;
    }
    const Candidate shaped = candidate_of("second_thermal_mass", shapes);
    const plant::EffectSetting truth = of_size(shaped, shapes[1], 0.3);
    ASSERT_TRUE(has_a_shape(shaped));

    const Candidate level = candidate_of("hall_offset", {{0.02, 0.0}});
    const Hypothesis others{of_size(level, level.shapes.front(), 0.0)};
    const std::vector<Window> all = testing::equal_windows(windows, values);
    const auto found =
        screened_shapes([&](const Hypothesis& hypothesis) { return errors_of(hypothesis, truth, 0.7); }, all,
                        Wanted(windows, 1), others, grid_of(std::array{&shaped}), 1e3, 1e3);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found.front().setting.values[1], 8.0);
    EXPECT_NEAR(typical_sizes(found.front().setting), 0.3, 0.01);
}

TEST(ShapeScreening, SecondShapeIsTheOne_ThatSavesMostBesideTheFirst) {
    const auto with_shapes = [](std::string_view name, std::initializer_list<double> taus) {
        std::vector<double> typical;
        for (const plant::EffectParameter& parameter : plant::find_effect(name)->parameters)
            typical.push_back(parameter.typical);
        std::vector<std::vector<double>> shapes(taus.size(), typical);
        std::ranges::transform(shapes, taus, shapes.begin(), [](std::vector<double> shape, double tau) {
            shape[1] = tau;
            return shape;
        });
        return candidate_of(name, std::move(shapes));
    };
    const Candidate slow = with_shapes("second_thermal_mass", {0.05, 0.2, 5.0}),
                    fast = with_shapes("macro_coupling", {0.05, 0.2, 5.0});
    const plant::EffectSetting of_slow = of_size(slow, slow.shapes[2], 1.0),
                               of_fast = of_size(fast, fast.shapes[1], 0.3);
    const auto predict = [&](const Hypothesis& hypothesis) {
        Errors errors = errors_of(hypothesis, of_slow, 0.0);
        for (std::size_t k = 0; k < errors.size(); ++k)
            errors[k] -= static_cast<float>(typical_sizes(of_fast) * wave_of(of_fast, k));
        return errors;
    };
    const std::vector<Window> all = testing::equal_windows(windows, values);
    const auto found =
        screened_shapes(predict, all, Wanted(windows, 1), {}, grid_of(std::array{&slow, &fast}), 1e3, 1e3);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].candidate, &slow);
    EXPECT_EQ(found[0].setting.values[1], 5.0);
    EXPECT_EQ(found[1].candidate, &fast);
    EXPECT_EQ(found[1].setting.values[1], 0.2);
    EXPECT_NEAR(typical_sizes(found[1].setting), 0.3, 0.01);
}

TEST(ShapeScreening, WhatCouldOnlyBeThereTheOtherWay_PromisesNothing) {
    const plant::Effect& mass = *plant::find_effect("second_thermal_mass");
    std::vector<double> typical;
    for (const plant::EffectParameter& parameter : mass.parameters) typical.push_back(parameter.typical);
    const Candidate shaped = candidate_of("second_thermal_mass", {typical});
    const plant::EffectSetting there = of_size(shaped, typical, 0.3);
    // The recording lacks what the effect, which cannot be negative, would add.
    const auto predict = [&](const Hypothesis& hypothesis) {
        Errors errors = errors_of(hypothesis, there, 0.0);
        const Errors twice = errors_of({there}, there, 0.0), once = errors_of({}, there, 0.0);
        for (std::size_t k = 0; k < errors.size(); ++k) errors[k] += 2.0F * (twice[k] - once[k]);
        return errors;
    };
    const std::vector<Window> all = testing::equal_windows(windows, values);
    for (const ScreenedShape& shape :
         screened_shapes(predict, all, Wanted(windows, 1), {}, grid_of(std::array{&shaped}), 1e3, 1e3))
        EXPECT_LE(shape.gain, 0.0);
}

TEST(ShapeScreening, WhatTheOthersExplain_PromisesNothing) {
    const plant::Effect& mass = *plant::find_effect("second_thermal_mass");
    std::vector<double> typical;
    for (const plant::EffectParameter& parameter : mass.parameters) typical.push_back(parameter.typical);
    const Candidate shaped = candidate_of("second_thermal_mass", {typical}),
                    level = candidate_of("hall_offset", {{0.02, 0.0}});
    const Hypothesis others{of_size(level, level.shapes.front(), 0.0)};
    const plant::EffectSetting none = of_size(shaped, typical, 0.0);
    const std::vector<Window> all = testing::equal_windows(windows, values);
    const auto found =
        screened_shapes([&](const Hypothesis& hypothesis) { return errors_of(hypothesis, none, 0.7); }, all,
                        Wanted(windows, 1), others, grid_of(std::array{&shaped}), 1e3, 1e3);
    for (const ScreenedShape& shape : found) EXPECT_LT(shape.gain, 1e-3);
}

}  // namespace

}  // namespace fidservo
