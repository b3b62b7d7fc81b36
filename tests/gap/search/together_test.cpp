// SPDX-License-Identifier: GPL-3.0-or-later
// What a search finds at once: where one signal is far off for a reason of its own, the others are explained.
#include "gap/search/search.h"
#include "tests/gap/effects.h"
#include "tests/gap/simulated_campaign.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::effects;
using ::testing::IsSupersetOf;

std::vector<std::string_view> names_of(const Search::Together& together) {
    std::vector<std::string_view> names;
    for (const Candidate* candidate : together.candidates) names.push_back(candidate->effect->name);
    return names;
}

TEST(SlowTogether, TagsThatAreFarOffForAnotherReason_DoNotHideSmallCausesOfTheWire) {
    const Evidence evidence =
        testing::campaign(effects({"encoder_ripple:amplitude_um=800,period_mm=9.3", "heater_delay:delay_ms=3",
                                   "heating_lag:factor=1.03"}),
                          {"macro-sweep", "micro-steps", "micro-triangle"});
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    Search search(evidence, all, {});
    EXPECT_THAT(names_of(search.everything_beside(search.nothing())),
                IsSupersetOf({"heater_delay", "heating_lag"}));
}

TEST(SlowTogether, WaveOfTheReading_IsFoundInTheTagsWhateverMovesTheCarriage) {
    const Evidence evidence = testing::campaign(
        effects({"encoder_ripple:amplitude_um=150,period_mm=9.3,phase_rad=1", "drive_gain:factor=0.95"}),
        {"macro-pulses", "macro-square", "micro-servo"});
    const std::vector<Candidate> all = candidates(evidence, {}, {});
    Search search(evidence, all, {});
    const std::vector<Search::Together> found =
        search.shaped_beside(search.nothing(), Search::SmoothSignals::tags_alone);
    ASSERT_FALSE(found.empty());
    const auto best = std::ranges::min_element(
        found, {}, [](const Search::Together& together) { return together.fitted.loss; });
    const Hypothesis& settings = best->fitted.of_half[0];
    const auto ripple =
        std::ranges::find(settings, plant::find_effect("encoder_ripple"), &plant::EffectSetting::effect);
    ASSERT_NE(ripple, settings.end());
    EXPECT_NEAR(ripple->values[1], 9.3, 0.05 * 9.3);
}

/// A few windows in which stick-slip decides otherwise stay far off whatever is explained.
TEST(Search, GainInMostWindowsOfTheEncoder_IsRealThoughAFewStayFarOff) {
    const std::vector<Candidate> none;
    const Evidence evidence = testing::campaign({}, {"macro-square", "macro-sweep"});
    const Search search(evidence, none, {});
    const auto with_others_at = [&](double mean_square) {
        CrossFit cross;
        for (std::size_t w = 0; w < evidence.windows().size(); ++w)
            cross.mean_squares.push_back(w % 10 == 0 ? 1e5 : mean_square);
        return cross;
    };
    EXPECT_TRUE(search.is_real(with_others_at(16.0), with_others_at(2.0)));
    EXPECT_FALSE(search.is_real(with_others_at(16.0), with_others_at(15.0)));
}

}  // namespace

}  // namespace fidservo
