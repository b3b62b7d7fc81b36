// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/recipe/recipe.h"

#include "core/input_error.h"
#include "tests/inspect/small_recipe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::inspect {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Recipe parsed(const std::string& text) {
    return parse_recipe(text, "recipe.yaml", small_rig());
}

/// The one line that the user reads.
std::string complaint(const std::string& text) {
    try {
        parsed(text);
    } catch (const InputError& problem) {
        return problem.what();
    }
    return "nothing was wrong";
}

TEST(Recipe, Small_SitesViewsAndChecksAreRead) {
    const Recipe recipe = parsed(small_recipe);
    ASSERT_EQ(recipe.sites.size(), 2u);
    EXPECT_EQ(recipe.sites[1].tag_id, 20);
    EXPECT_DOUBLE_EQ(recipe.sites[1].fiducial_mm.x(), 40.0);
    ASSERT_EQ(recipe.sites[1].views.size(), 2u);
    EXPECT_DOUBLE_EQ(recipe.sites[1].views[0].offset_um, -1000.0);
    const auto& mark = std::get<MarkCheck>(recipe.sites[1].views[1].checks.at(0));
    EXPECT_EQ(mark.feature, "dot@20");
    EXPECT_DOUBLE_EQ(mark.size_tolerance_um, 15.0);
}

TEST(Recipe, Pattern_IsPrintedBesideEverySite) {
    const Recipe recipe = parsed(small_recipe);
    EXPECT_EQ(recipe.nominal.features.size(), 6u);
    const Feature* dot = find_feature(recipe.nominal, "dot@20");
    ASSERT_NE(dot, nullptr);
    EXPECT_TRUE(std::get<Dot>(dot->shape).centre_mm.isApprox(Eigen::Vector2d(41.0, -1.3)));
}

TEST(Recipe, OrderLeftwards_SitesAreSorted) {
    const Recipe recipe = parsed(spoilt("tags: [10, 20]", "tags: [10, 30, 20]\n  order: leftwards"));
    EXPECT_EQ(recipe.sites[0].tag_id, 30);
    EXPECT_EQ(recipe.sites[2].tag_id, 10);
}

TEST(Recipe, Exceptions_ChangeOneSite) {
    const Recipe recipe = parsed(spoilt("tags: [10, 20]",
                                        "tags: {first: 10, step: 10, count: 2}\n"
                                        "  on_failure: {retries: 2, then: skip}\n"
                                        "  exceptions:\n"
                                        "    - {tag: 20, on_failure: {then: defer}, views: [right]}"));
    EXPECT_FALSE(recipe.sites[0].on_failure.defer);
    EXPECT_TRUE(recipe.sites[1].on_failure.defer);
    EXPECT_EQ(recipe.sites[1].on_failure.retries, 2);
    ASSERT_EQ(recipe.sites[1].views.size(), 1u);
    EXPECT_EQ(recipe.sites[1].views[0].name, "right");
}

struct Mistake {
    const char* name;
    std::string from, to, says;
};

void PrintTo(const Mistake& mistake, std::ostream* out) {
    *out << mistake.name;
}

class RecipeMistake : public testing::TestWithParam<Mistake> {};

TEST_P(RecipeMistake, IsRefusedInOneLine) {
    const Mistake& mistake = GetParam();
    ASSERT_THAT(small_recipe, HasSubstr(mistake.from));
    const std::string line = complaint(spoilt(mistake.from, mistake.to));
    EXPECT_THAT(line, AllOf(HasSubstr("recipe.yaml:"), HasSubstr(mistake.says)));
    EXPECT_EQ(line.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    Each, RecipeMistake,
    testing::Values(
        Mistake{"UnknownKey", "offset_um: -1000", "ofset_um: -1000", "ofset_um"},
        Mistake{"WrongType", "offset_um: -1000", "offset_um: left", "left"},
        Mistake{"ToleranceZero", "tolerance_um: 15}", "tolerance_um: 0}", "tolerance_um"},
        Mistake{"ToleranceNegative", "width_tolerance_um: 10", "width_tolerance_um: -10",
                "width_tolerance_um"},
        Mistake{"SiteTwice", "tags: [10, 20]", "tags: [10, 10]", "10 is listed twice"},
        Mistake{"SiteNotOnPlate", "tags: [10, 20]", "tags: [10, 300]", "300 is not on the plate"},
        Mistake{"IdTwice", "side_mm: 1.2}",
                "side_mm: 1.2}\n  tags: [{id: 3, centre_mm: [6, 0], side_mm: 1.2}]",
                "is on the plate already"},
        Mistake{"RowOutOfView", "rows: 1, pitch_mm: [2.0, 0.0], first_id: 0, side_mm: 1.2}",
                "rows: 1, pitch_mm: [2.0, 0.0], first_id: 0, side_mm: 1.2, origin_mm: [0, 1.5]}", "one axis"},
        Mistake{"SiteOutOfTravel", "tags: [10, 20]", "tags: [0, 20]", "the stage reaches"},
        Mistake{"FiducialOutOfView", "offset_um: -1000", "offset_um: -2000",
                "its fiducial is not wholly in view"},
        Mistake{"FeatureOutOfView", "centre_mm: [1.0, -1.3]", "centre_mm: [-2.0, -1.3]",
                "dot@10 is not wholly in view"},
        Mistake{"FeatureNotThere", "feature: dot", "feature: dots", "dots is not among"},
        Mistake{"FeatureOfWrongKind", "mark: {feature: dot", "mark: {feature: line", "no dot and no pad"},
        Mistake{"EdgeOfDot", "[line, fiducial]", "[line, dot]", "no straight edge"},
        Mistake{"NoNeighbour", "pitch_mm: [2.0, 0.0]", "pitch_mm: [3.2, 0.0]", "needs another fiducial"},
        Mistake{"ViewNameTwice", "name: right", "name: left", "exists already"},
        Mistake{"NoSuchImage", "longest_defect_um: 20", "longest_defect_um: 20, image: nowhere.png",
                "no such file"},
        Mistake{"NoSuchPlate", "name: small", "name: small\nsimulation: {plate: nowhere.yaml}",
                "simulation.plate: nowhere.yaml: there is no such file as nowhere.yaml"},
        Mistake{"ExceptionForNoSite", "tags: [10, 20]", "tags: [10, 20]\n  exceptions: [{tag: 11}]",
                "11 is no site"},
        Mistake{"SearchBelowTolerance", "size_tolerance_um: 15}", "size_tolerance_um: 15, search_um: 5}",
                "smaller than the tolerance"}),
    [](const auto& mistake) { return mistake.param.name; });

}  // namespace
}  // namespace fidservo::inspect
