// SPDX-License-Identifier: GPL-3.0-or-later
// Rigs with many causes at once have the stated properties.
#include "src/selfcheck/draw/crowded_draw.h"

#include "core/rig.h"
#include "gap/candidates/candidate.h"
#include "gap/fit/gap_size.h"
#include "gap/fit/score.h"
#include "plant/effects/catalogue.h"
#include "src/files/rig/rig_file.h"
#include "src/selfcheck/draw/campaign.h"
#include "src/selfcheck/draw/discrepancy_draw.h"
#include "src/selfcheck/draw/gap_alone.h"
#include "src/selfcheck/draw/other_formulas.h"
#include "tests/effort.h"
#include "tests/selfcheck/messy_cases.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace fidservo::selfcheck {
namespace {

using fidservo::testing::first_crowded_case;

const Rig& nominal() {
    static const Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    return rig;
}

std::vector<Case> cases_of_three(std::uint64_t seed, std::size_t count) {
    std::vector<Case> cases;
    for (std::size_t number = 0; cases.size() < count; ++number)
        if (kind_of_crowded_case(seed, number) == CaseKind::three)
            cases.push_back(draw_crowded_case(nominal(), seed, number));
    return cases;
}

void expect_same(const Case& a, const Case& b) {
    EXPECT_EQ(a.campaign_seed, b.campaign_seed);
    fidservo::testing::expect_same_label(a.label, b.label);
}

TEST(CrowdedDraw, ThreeCasesInARow_AreOfAllKinds) {
    for (const std::uint64_t seed : {1, 2, 3}) {
        std::set<CaseKind> kinds;
        for (std::size_t number = 6; number < 9; ++number) kinds.insert(kind_of_crowded_case(seed, number));
        EXPECT_EQ(kinds.size(), 3u);
        for (const CaseKind kind : kinds) EXPECT_TRUE(is_crowded(kind));
    }
    EXPECT_FALSE(is_crowded(CaseKind::two) || is_crowded(CaseKind::frames));
}

TEST(CrowdedDraw, ThreeEffects_AreOfThreeBlocksAndGoTogether) {
    for (const Case& drawn : cases_of_three(9, 200)) {
        ASSERT_EQ(drawn.label.effects.size(), 3u);
        std::set<std::string> blocks;
        for (const TrueEffect& effect : drawn.label.effects) {
            blocks.insert(effect.block);
            for (const TrueEffect& other : drawn.label.effects)
                EXPECT_TRUE(&effect == &other || can_be_together(effect.class_name, other.class_name));
        }
        EXPECT_EQ(blocks.size(), 3u);
    }
}

TEST(CrowdedDraw, ThreeEffects_OneRoundBeginsWithEveryClassOnce) {
    std::map<std::string, int> met;
    for (const Case& drawn : cases_of_three(5, listed_classes().size()))
        ++met[drawn.label.effects.front().class_name];
    EXPECT_EQ(met.size(), listed_classes().size());
}

TEST(CrowdedDraw, ThreeEffectsOfOneSeedAndNumber_AreTheSame) {
    const std::vector<Case> drawn = cases_of_three(7, 2), again = cases_of_three(7, 2);
    expect_same(drawn[0], again[0]);
    expect_same(drawn[1], again[1]);
    EXPECT_NE(drawn[0].campaign_seed, drawn[1].campaign_seed);
}

TEST(OtherFormulas, Names_AreOfListedEffectsAndOfNoListedFormula) {
    for (const EffectDraw& other : other_formulas()) {
        const std::vector<const EffectDraw*> listed = draws_of(gap::class_of(other.effect));
        EXPECT_TRUE(std::ranges::any_of(listed, [&](const EffectDraw* way) {
            return way->effect == other.effect;
        })) << other.effect;
        EXPECT_TRUE(std::ranges::none_of(
            listed, [&](const EffectDraw* way) { return way->formula == other.formula; }))
            << other.effect << ' ' << other.formula;
    }
    EXPECT_TRUE(other_formulas_of("backlash").empty());
}

/// Whether a recording in which all stages move differs from that of the nominal rig.
bool shows(const TrueRig& rig) {
    const auto record = [](const TrueRig& true_rig) {
        constexpr int few_substeps = 4;
        return record_run(nominal(), true_rig, {"integrated", "integrated-1"}, 3, few_substeps);
    };
    static const Recording plain = record({nominal(), {}});
    const Recording other = record(rig);
    for (std::size_t k = 0; k < plain.rows.size(); ++k)
        if (plain.rows[k].encoder_count != other.rows[k].encoder_count ||
            plain.rows[k].hall_adc != other.rows[k].hall_adc)
            return true;
    for (std::size_t k = 0; k < std::min(plain.detections.size(), other.detections.size()); ++k)
        if (plain.detections[k].corners_px[0].x() != other.detections[k].corners_px[0].x()) return true;
    return plain.detections.size() != other.detections.size();
}

TEST(SlowOtherFormulas, AtATenthOfTheLargest_ShowInARecording) {
    for (const EffectDraw& other : other_formulas()) {
        TrueRig rig{nominal(), {}};
        NoiseStream draw(1, "other formula");
        other.put(rig.departures, 0.1 * other.largest, draw);
        EXPECT_TRUE(shows(rig)) << other.effect << ' ' << other.formula;
    }
}

TEST(DiscrepancyDraw, EveryKind_ShowsInARecordingAndVanishesAtSizeZero) {
    for (const DiscrepancyKind& kind : discrepancy_kinds())
        for (const double size : {0.0, 0.3 * kind.largest}) {
            TrueRig rig{nominal(), {}};
            NoiseStream draw(1, "discrepancy");
            rig.departures.discrepancy = draw_discrepancy(kind, nominal(), size, draw);
            EXPECT_EQ(shows(rig), size > 0.0) << kind.block << ' ' << kind.depends_on;
        }
}

void expect_between(double value, const double (&limits)[2], const char* what) {
    EXPECT_GE(value, limits[0]) << what;
    EXPECT_LE(value, limits[1]) << what;
}

void expect_messy(const Label& label, bool has_dominant) {
    std::vector<TrueEffect> small = label.effects;
    if (has_dominant) small.erase(small.begin());
    ASSERT_EQ(small.size(), small_effects);
    std::set<std::string> classes;
    for (const TrueEffect& effect : label.effects) classes.insert(effect.class_name);
    EXPECT_EQ(classes.size(), label.effects.size());
    for (const TrueEffect& effect : small) {
        expect_between(effect.gap_floors, small_floors, effect.effect.c_str());
        EXPECT_TRUE(!has_dominant || label.effects.front().gap_floors >= dominance * effect.gap_floors)
            << effect.effect;
    }
    if (has_dominant) expect_between(label.effects.front().gap_floors, dominant_floors, "dominant");
    ASSERT_TRUE(label.discrepancy);
    expect_between(label.discrepancy->gap_floors, discrepancy_floors, "discrepancy");
}

/// That drawing them again gives the same ones is tested in self_check_test.cpp.
TEST(SlowCrowdedDraw, MessyRigs_KeepTheirGaps) {
    expect_messy(first_crowded_case(CaseKind::messy).label, true);
    if (fidservo::testing::has_all_draws())
        expect_messy(first_crowded_case(CaseKind::messy_none).label, false);
}

/// The search for a size uses fewer integration sub-steps than the recording of a case.
TEST(SlowGapAlone, OfADiscrepancy_IsThatOfTheFullModel) {
    const Case& drawn = first_crowded_case(CaseKind::messy);
    TrueRig alone{nominal(), {}};
    alone.departures.discrepancy = drawn.true_rig.departures.discrepancy;
    const gap::Evidence evidence(nominal(), record_campaign(nominal(), alone, drawn.campaign_seed));
    const auto squares = gap::mean_squares(evidence.windows(), evidence.errors({}, everything(evidence)));
    const double gap = total_gap(signal_gaps(evidence, squares, squares)).before;
    const double measured = drawn.label.discrepancy->gap_floors;
    EXPECT_NEAR(std::sqrt(gap * gap - 1.0), measured, 0.02 * measured);
}

}  // namespace
}  // namespace fidservo::selfcheck
