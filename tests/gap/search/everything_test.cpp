// SPDX-License-Identifier: GPL-3.0-or-later
// The joint fit of all smooth candidates, and which of them the data need.
#include "gap/search/everything.h"

#include "gap/evidence/halves.h"
#include "tests/gap/effects.h"
#include "tests/gap/simulated_campaign.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::effects;

Recording recorded(std::string_view kind, const Hypothesis& truth, std::uint64_t seed) {
    const std::string name = std::string(kind) + "-" + std::to_string(seed);
    return simulate(reference_rig(), truth, make_experiment(kind, reference_rig(), seed, name), name, seed);
}

Evidence wire_campaign(const Hypothesis& truth, std::shared_ptr<const Budget> budget = {}) {
    std::vector<Recording> recordings;
    for (const std::string_view kind : {"micro-steps", "micro-triangle"})
        for (const std::uint64_t seed : {51, 52}) recordings.push_back(recorded(kind, truth, seed));
    return {reference_rig(), std::move(recordings), std::move(budget)};
}

std::array<Wanted, 2> hall_of_halves(const Evidence& evidence) {
    const std::vector<std::uint8_t> half = halves(evidence);
    std::array<Wanted, 2> wanted{everything(evidence), everything(evidence)};
    for (std::size_t w = 0; w < half.size(); ++w)
        for (std::size_t side = 0; side < 2; ++side)
            if (half[w] != side || evidence.windows()[w].signal != Signal::hall) wanted[side][w] = 0;
    return wanted;
}

struct Found {
    std::vector<std::string> names;
    NeededCandidates needed;
};

Found needed_of(const Evidence& evidence) {
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    std::vector<const Candidate*> smooth;
    for (const Candidate& candidate : all)
        if (is_smooth(candidate) &&
            std::ranges::find(smooth, candidate.class_name, &Candidate::class_name) == smooth.end())
            smooth.push_back(&candidate);
    Found found{
        {}, needed_of_everything(evidence, smooth, {}, {}, {}, hall_of_halves(evidence), IfFar::gives_up)};
    for (const Candidate* candidate : found.needed.candidates) found.names.push_back(candidate->class_name);
    std::ranges::sort(found.names);
    return found;
}

TEST(SlowEverything, FourSmallCausesOfTheWire_AreAllFound_WithTheirValues_AndNoOther) {
    const Hypothesis truth = effects({"ambient_temperature:shift_degC=0.5", "heating_lag:factor=1.03",
                                      "heater_delay:delay_ms=3", "stroke_change:factor=0.99"});
    const Evidence evidence = wire_campaign(truth);
    const Found found = needed_of(evidence);
    ASSERT_EQ(found.needed.candidates.size(), 4U);
    for (const plant::EffectSetting& setting : found.needed.of_half[0]) {
        const auto same = std::ranges::find(truth, setting.effect, &plant::EffectSetting::effect);
        ASSERT_NE(same, truth.end()) << setting.effect->name;
        const double typical =
            std::abs(setting.effect->parameters[0].typical - setting.effect->parameters[0].vanishing);
        EXPECT_NEAR(setting.values[0], same->values[0], 0.02 * typical) << setting.effect->name;
    }
}

TEST(SlowEverything, BudgetThatEndsOnTheWay_LeavesWhatIsNeededAsFarAsIsKnown) {
    const Hypothesis truth =
        effects({"ambient_temperature:shift_degC=0.5", "heating_lag:factor=1.03", "heater_delay:delay_ms=3"});
    const auto needed_within = [&](int most_asked, int& asked_in_all) {
        std::atomic<int> asked = 0;
        std::atomic<bool> is_prepared = false;
        const auto budget =
            std::make_shared<const Budget>(1e6, 1e6, [&] { return is_prepared && ++asked > most_asked; });
        const Evidence evidence = wire_campaign(truth, budget);
        is_prepared = true;
        NeededCandidates needed;
        try {
            needed = needed_of(evidence).needed;
        } catch (const BudgetEnded&) {
            needed.ended = Ended::interrupted;
        }
        asked_in_all = asked;
        return needed;
    };
    int asked = 0, ignored = 0, with_something = 0;
    const NeededCandidates whole = needed_within(std::numeric_limits<int>::max(), asked);
    EXPECT_FALSE(whole.ended);
    for (const double share : {0.1, 0.6, 0.7, 0.8, 0.9, 0.95}) {
        const NeededCandidates part = needed_within(static_cast<int>(share * asked), ignored);
        ASSERT_TRUE(part.ended) << share;
        EXPECT_EQ(part.worth.size(), part.candidates.size()) << share;
        EXPECT_EQ(part.of_half[0], part.of_half[1]) << share;
        if (part.candidates.empty()) continue;
        ++with_something;
        for (const plant::EffectSetting& setting : whole.of_half[0])
            EXPECT_NE(std::ranges::find(part.of_half[0], setting.effect, &plant::EffectSetting::effect),
                      part.of_half[0].end())
                << setting.effect->name << " at " << share;
    }
    EXPECT_GE(with_something, 2);
}

/// The derivatives that lead there are those at the present values, not those over a hundredth of a typical
/// size: the valley of what the wire's effects have in common is narrower.
TEST(SlowEverything, GainFarFromNominal_IsFoundWithWhatIsSmallBesideIt_AndNoOther) {
    const Found found =
        needed_of(wire_campaign(effects({"heater_gain:factor=0.915", "hall_drift:rate_mV_per_s=0.08"})));
    EXPECT_EQ(found.names, (std::vector<std::string>{"hall_drift", "heater_gain"}));
}

/// A supply that is 1 % high shows as a gain about 0 V, or as one about the middle voltage and an offset.
TEST(SlowEverything, GainAbout0V_IsNoGainAboutTheMiddleVoltageAndAnOffset) {
    const Found found =
        needed_of(wire_campaign(effects({"hall_gain:factor=1.01,about_mid=0", "heater_delay:delay_ms=3"})));
    EXPECT_EQ(found.names, (std::vector<std::string>{"hall_gain", "heater_delay"}));
}

TEST(SlowEverything, SearchThatEndsOnTheWay_LeavesTimeForTheOtherHalf) {
    const Hypothesis truth =
        effects({"ambient_temperature:shift_degC=0.5", "heating_lag:factor=1.03", "heater_delay:delay_ms=3"});
    constexpr double endless_s = 1e6;
    const auto budget_of = [&](double search_s) {
        return std::make_shared<const Budget>(search_s, endless_s, std::function<bool()>(),
                                              Seconds::by_effort);
    };
    const auto whole = budget_of(endless_s);
    const Evidence without_end = wire_campaign(truth, whole);
    const double before_s = static_cast<double>(whole->rows()) / rows_a_second;
    ASSERT_FALSE(needed_of(without_end).needed.ended);
    const double whole_s = static_cast<double>(whole->rows()) / rows_a_second - before_s;
    const NeededCandidates part =
        needed_of(wire_campaign(truth, budget_of(before_s + 0.85 * whole_s))).needed;
    EXPECT_EQ(part.ended, Ended::budget);
    EXPECT_EQ(part.of_half[0].size(), truth.size());
    // The halves differ by noise, some by less than what ends a fit.
    EXPECT_EQ(part.worth.size(), truth.size());
}

TEST(Everything, NominalRig_NeedsNothing) {
    EXPECT_TRUE(needed_of(wire_campaign({})).names.empty());
}

TEST(Everything, WhatIsFarOff_ForAnotherReason_IsLeftToOthers) {
    const Evidence evidence = wire_campaign(effects({"second_thermal_mass:conductance=0.4,mass_tau_s=8"}));
    EXPECT_TRUE(needed_of(evidence).names.empty());
}

/// Something else is left, so that other shapes are tried, which do no better.
TEST(Everything, ShapeOfWhatIsThere_StaysAsItWasFitted_BesideWhatIsNoCandidate) {
    const double mass_tau_s = 4.0;
    const Evidence evidence = wire_campaign(
        effects({"second_thermal_mass:conductance=0.4,mass_tau_s=4", "hall_nonlinearity:cubic_shift=0.02"}));
    const std::vector<Candidate> all =
        candidates(evidence, std::array<std::string, 1>{"second_thermal_mass"}, {});
    const std::vector<const Candidate*> one{&all.front()};
    const NeededCandidates found =
        needed_of_everything(evidence, one, {}, effects({"second_thermal_mass:conductance=0.4,mass_tau_s=4"}),
                             {}, hall_of_halves(evidence), IfFar::goes_on);
    ASSERT_EQ(found.candidates, one);
    for (const Hypothesis& half : found.of_half)
        EXPECT_NEAR(half.front().values[1], mass_tau_s, 0.25 * mass_tau_s);
}

TEST(Everything, IsOfWireSensorsAndView_NotOfTheCarriage) {
    const Evidence evidence = wire_campaign({});
    for (const Candidate& candidate : candidates(evidence, {}, {})) {
        const plant::Part part = candidate.effect->part;
        EXPECT_EQ(is_smooth(candidate), part != plant::Part::carriage && !candidate.is_limit)
            << candidate.effect->name;
    }
}

}  // namespace

}  // namespace fidservo
