// SPDX-License-Identifier: GPL-3.0-or-later
// Predictions of which a part is known, against those of everything anew.
#include "gap/fit/incremental_prediction.h"

#include "tests/gap/effects.h"
#include "tests/gap/simulated_campaign.h"

#include <cmath>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::effects;

class IncrementalPredictions : public ::testing::Test {
  protected:
    void expect_same_as_anew(const Hypothesis& settings) {
        Hypothesis whole = beside;
        whole.insert(whole.end(), settings.begin(), settings.end());
        const Errors anew = evidence.errors(whole, all), found = predict(settings);
        ASSERT_EQ(found.size(), anew.size());
        std::size_t different = 0;
        for (std::size_t k = 0; k < anew.size(); ++k)
            if (found[k] != anew[k] && !(std::isnan(found[k]) && std::isnan(anew[k]))) ++different;
        EXPECT_EQ(different, 0U) << settings.back().effect->name;
    }

    const Evidence evidence = testing::campaign(effects({"drive_gain:factor=1.02"}), {"integrated"});
    const Hypothesis beside = effects({"payload:mass_factor=1.05"});
    const Wanted all = everything(evidence);
    IncrementalPrediction predict{evidence, beside, all};
};

TEST_F(IncrementalPredictions, OfOneOtherSetting_AreThoseAnew) {
    const Hypothesis base = effects({"drive_gain:factor=1.01", "hall_gain", "pixel_scale"});
    expect_same_as_anew(base);
    for (std::size_t k = 0; k < base.size(); ++k) {
        Hypothesis other = base;
        other[k].values[0] *= 1.001;
        expect_same_as_anew(other);
    }
}

TEST_F(IncrementalPredictions, OfAFurtherOrOneLess_AreThoseAnew) {
    const Hypothesis base = effects({"drive_gain:factor=1.01", "hall_gain"});
    expect_same_as_anew(base);
    for (const std::string_view further : {"camera_tilt", "encoder_scale", "macro_coupling", "cogging"}) {
        Hypothesis longer = base;
        longer.push_back(effects({further}).front());
        expect_same_as_anew(longer);
    }
    expect_same_as_anew({base.front()});
    expect_same_as_anew(base);
}

TEST_F(IncrementalPredictions, OfAPlatformThatFeelsTheCarriage_FollowIt) {
    const Hypothesis base = effects({"macro_coupling", "drive_gain:factor=1.01", "hall_gain"});
    expect_same_as_anew(base);
    Hypothesis other = base;
    other[1].values[0] = 1.012;
    expect_same_as_anew(other);
}

}  // namespace

}  // namespace fidservo
