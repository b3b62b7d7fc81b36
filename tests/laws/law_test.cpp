// SPDX-License-Identifier: GPL-3.0-or-later
// Every effect of the catalogue does what its equation says, contains the simpler effect that it says it
// contains, and is recovered from recordings.
#include "core/rig.h"
#include "gap/candidates/candidate.h"
#include "gap/diagnose.h"
#include "plant/effects/catalogue.h"
#include "src/simulation/simulate.h"
#include "src/simulation/simulate_reference.h"
#include "tests/gap/effect_names.h"
#include "tests/gap/looks.h"
#include "tests/laws/effect_law.h"
#include "tests/reference_rig.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using plant::Effect;
using plant::EffectSetting;
using testing::EffectLaw;
using testing::law_of;

constexpr std::uint64_t seed = 12;

/// The reference rig with sensors that are finer and have no noise, so that recordings can be compared to a
/// fraction of the real sensors' floors.
Rig exact_rig() {
    Rig rig = reference_rig();
    rig.macro.encoder_resolution_mm *= 0.02;
    rig.micro->hall.noise_lsb = 0.0;
    rig.camera->corner_noise_px = 0.0;
    return rig;
}

/// R.m.s. differences of two recordings with the same commands, in floors of the reference rig.
struct Difference {
    double encoder = 0.0, hall = 0.0, tags = 0.0;
    std::size_t rows_apart = 0, tags_apart = 0;  ///< by which one has more than the other

    double largest() const { return std::max({encoder, hall, tags}); }
};

Difference difference(const Recording& one, const Recording& other) {
    const Rig& rig = reference_rig();
    const double count = exact_rig().macro.encoder_resolution_mm / rig.macro.encoder_resolution_mm;
    const double encoder_floor = std::sqrt(1.0 / 12.0),
                 hall_floor = std::hypot(rig.micro->hall.noise_lsb, std::sqrt(1.0 / 12.0));
    double encoder = 0.0, hall = 0.0, tags = 0.0;
    const std::size_t rows = std::min(one.rows.size(), other.rows.size());
    for (std::size_t k = 0; k < rows; ++k) {
        const StageRow &a = one.rows[k], &b = other.rows[k];
        encoder +=
            std::pow(count * static_cast<double>(a.encoder_count - b.encoder_count) / encoder_floor, 2);
        hall += std::pow((a.hall_adc - b.hall_adc) / hall_floor, 2);
    }
    std::size_t seen = 0, i = 0, j = 0;
    while (i < one.detections.size() && j < other.detections.size()) {
        const TagDetection &a = one.detections[i], &b = other.detections[j];
        if (a.time_ns != b.time_ns) {
            ++(a.time_ns < b.time_ns ? i : j);
            continue;
        }
        for (std::size_t corner = 0; corner < 4; ++corner)
            tags += (a.corners_px[corner] - b.corners_px[corner]).squaredNorm() / 8.0 /
                    std::pow(rig.camera->corner_noise_px, 2);
        ++seen, ++i, ++j;
    }
    const auto mean = [](double sum, std::size_t count_of) {
        return count_of > 0 ? std::sqrt(sum / static_cast<double>(count_of)) : 0.0;
    };
    const auto apart = [](std::size_t a, std::size_t b) { return a > b ? a - b : b - a; };
    return {mean(encoder, rows), mean(hall, rows), mean(tags, seen),
            apart(one.rows.size(), other.rows.size()),
            one.detections.size() + other.detections.size() - 2 * seen};
}

class EffectLaws : public ::testing::TestWithParam<const Effect*> {};
class EffectRecovery : public ::testing::TestWithParam<const Effect*> {};

TEST_P(EffectLaws, Recording_IsThatOfTheIndependentModel) {
    const EffectLaw* law = law_of(*GetParam());
    ASSERT_NE(law, nullptr) << "every effect needs a line in tests/laws/effect_law.cpp";
    if (plant::is_of_frames(GetParam()->part)) return;  // see picture_law_test.cpp
    const Rig rig = exact_rig();
    const EffectSetting setting = plant::parse_effect(law->setting);
    reference::Departures departures;
    law->depart(departures, rig);
    double most_changed = 0.0;
    for (const char* kind : {"macro-pulses", "micro-steps"}) {
        const Experiment experiment = make_experiment(kind, rig, seed, kind);
        const Recording recording = simulate(rig, {&setting, 1}, experiment, kind, seed);
        const Difference apart =
            difference(recording, simulate_reference(rig, departures, experiment, kind, seed));
        const Difference changed = difference(recording, simulate(rig, {}, experiment, kind, seed));
        std::printf(
            "%-20s %-12s apart: encoder %.3f, Hall %.3f, tags %.3f floors, %zu tags; changed by %.3g, %zu "
            "tags\n",
            GetParam()->name.data(), kind, apart.encoder, apart.hall, apart.tags, apart.tags_apart,
            changed.largest(), changed.tags_apart);
        EXPECT_LT(apart.largest(), 0.1 + 5e-4 * changed.largest());
        EXPECT_EQ(apart.rows_apart, 0U);
        most_changed = std::max({most_changed, changed.largest(), static_cast<double>(changed.tags_apart)});
    }
    EXPECT_GT(most_changed, 10.0) << "values at which the law would not show";
}

TEST_P(EffectLaws, NearItsPlainerForm_MovesAsThatDoes) {
    const EffectLaw* law = law_of(*GetParam());
    if (GetParam()->plainer.effect == nullptr) return;
    ASSERT_NE(law, nullptr);
    ASSERT_FALSE(law->nearly_plainer.empty()) << "an effect that contains another one needs values near it";
    const Rig rig = exact_rig();
    const EffectSetting richer = plant::parse_effect(law->nearly_plainer);
    const EffectSetting plainer = gap::plain_form(richer, rig.macro);
    const Experiment experiment = make_experiment("macro-pulses", rig, seed, "macro-pulses");
    const auto run = [&](std::span<const EffectSetting> effects) {
        return simulate(rig, effects, experiment, "macro-pulses", seed);
    };
    const Recording plain = run({&plainer, 1});
    const double apart = difference(run({&richer, 1}), plain).encoder;
    const double changed = difference(plain, run({})).encoder;
    std::printf("%-20s apart by %.3g floors, changed by %.3g\n", GetParam()->name.data(), apart, changed);
    constexpr double nearly = 0.5;
    EXPECT_LT(apart, nearly * changed);
    EXPECT_GT(changed, 10.0);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EffectLaws,
                         ::testing::ValuesIn(plant::effect_catalogue().begin(),
                                             plant::effect_catalogue().end()),
                         ::testing::PrintToStringParamName());

/// What shows an effect to a diagnosis. Frames are not rendered: how tags look in them has a closed form.
std::vector<Recording> recordings_that_show(const EffectSetting& setting) {
    const Rig& rig = reference_rig();
    std::vector<Recording> recordings;
    for (const char* kind : {"macro-pulses", "macro-sweep", "micro-steps", "micro-triangle"}) {
        if (!setting.effect->block.starts_with("micro.") && std::string_view(kind).starts_with("micro"))
            continue;
        recordings.push_back(
            simulate(rig, {&setting, 1}, make_experiment(kind, rig, seed, kind), kind, seed));
    }
    if (!plant::is_of_frames(setting.effect->part)) return recordings;
    const plant::PlantParameters parameters = testing::with(setting);
    for (const double share : {1.0, 0.5})
        recordings.push_back(
            testing::looks_in_even_motion(*parameters.camera, share * testing::looks_px_per_s));
    return recordings;
}

TEST_P(EffectRecovery, OfItsRecordings_IsTheEffectWithItsSizes) {
    const EffectLaw* law = law_of(*GetParam());
    ASSERT_NE(law, nullptr);
    const EffectSetting truth = plant::parse_effect(law->setting);
    const gap::Evidence evidence(reference_rig(), recordings_that_show(truth));
    const gap::Diagnosis diagnosis =
        gap::diagnose(evidence, {.only = {std::string(GetParam()->name)}, .without = {}, .selection = {}});
    ASSERT_EQ(testing::names(diagnosis), std::vector{std::string(GetParam()->name)});
    for (const gap::FittedParameter& found : diagnosis.effects.front().parameters)
        for (std::size_t k = 0; k < truth.values.size(); ++k) {
            const plant::EffectParameter& parameter = GetParam()->parameters[k];
            if (found.name != parameter.name || !parameter.is_size()) continue;
            constexpr double errors = 5.0, share = 0.03, share_of_usual = 1e-4;
            EXPECT_NEAR(found.value, truth.values[k],
                        errors * found.std + share * std::abs(truth.values[k] - parameter.vanishing) +
                            share_of_usual * std::abs(parameter.usual() - parameter.vanishing))
                << found.name;
        }
}

INSTANTIATE_TEST_SUITE_P(SlowCatalogue, EffectRecovery,
                         ::testing::ValuesIn(plant::effect_catalogue().begin(),
                                             plant::effect_catalogue().end()),
                         ::testing::PrintToStringParamName());

}  // namespace
}  // namespace fidservo
