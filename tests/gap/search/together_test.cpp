// SPDX-License-Identifier: GPL-3.0-or-later
// What a search finds at once: where one signal is far off for a reason of its own, the others are explained.
#include "gap/search/search.h"
#include "tests/gap/effects.h"
#include "tests/gap/simulated_campaign.h"

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

}  // namespace

}  // namespace fidservo
