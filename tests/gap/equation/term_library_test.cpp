// SPDX-License-Identifier: GPL-3.0-or-later
// Terms of variables with a known range.
#include "gap/equation/term_library.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

const KnownVariable speed{.name = "speed", .unit = "mm/s", .range = {-200.0, 190.0}, .words = "speed"};
const KnownVariable place{.name = "place", .unit = "mm", .range = {20.0, 180.0}, .words = "place"};
const KnownVariable still{.name = "speed", .unit = "mm/s", .range = {0.0, 0.0}, .words = "speed"};

TEST(TermLibrary, VariableOfBothSigns_HasItsOriginAtZero_AnotherInTheMiddle) {
    EXPECT_DOUBLE_EQ(speed.origin(), 0.0);
    EXPECT_DOUBLE_EQ(place.origin(), 100.0);
    EXPECT_DOUBLE_EQ(speed.most(), 200.0);
    EXPECT_DOUBLE_EQ(place.reach(), 80.0);
}

TEST(TermLibrary, BeyondItsRange_AVariableKeepsItsEndValue) {
    EXPECT_EQ(place.clipped(), "clip(place, 20, 180)");
    EXPECT_EQ(place.centred(), "(clip(place, 20, 180) - 100)");
    EXPECT_EQ(speed.centred(), speed.clipped());
}

TEST(TermLibrary, UnitsOfPowers) {
    EXPECT_EQ(place.power_unit(1), "mm");
    EXPECT_EQ(place.power_unit(2), "mm2");
    EXPECT_EQ(speed.power_unit(3), "(mm/s)3");
}

TEST(TermLibrary, PowersHaveTheSizeOfTheirLargestValue) {
    TermLibrary library;
    library.add_powers(place, 3);
    std::vector<double> sizes;
    for (const Term& term : library.terms())
        if (term.shapes.empty()) sizes.push_back(term.size);
    EXPECT_THAT(sizes, ::testing::ElementsAre(180.0, std::pow(80.0, 2), std::pow(80.0, 3)));
}

TEST(TermLibrary, SquareAboutAnotherCentre_IsOfTheFamilyOfTheSquare) {
    TermLibrary library;
    library.add_powers(place, 2);
    ASSERT_EQ(library.terms().size(), 4U);
    EXPECT_NE(library.terms()[0].family, library.terms()[1].family);
    EXPECT_EQ(library.terms()[1].family, library.terms()[2].family);
    EXPECT_EQ(library.terms()[1].family, library.terms()[3].family);
    EXPECT_EQ(library.terms()[2].shapes.front().unit, "mm");
}

TEST(TermLibrary, WaveHasSineAndCosine_WithItsPeriodAsShape) {
    TermLibrary library;
    library.add_waves("place", std::vector{5.0, 12.0});
    ASSERT_EQ(library.terms().size(), 2U);
    EXPECT_EQ(library.terms()[0].texts.size(), 2U);
    EXPECT_DOUBLE_EQ(library.terms()[1].shapes.front().value, 12.0);
    EXPECT_LT(library.terms()[1].shapes.front().low, 12.0);
    EXPECT_GT(library.terms()[1].shapes.front().high, 12.0);
}

TEST(TermLibrary, StepsAndBells_BeginAtWidthsAndCentresWithinTheRange) {
    TermLibrary library;
    library.add_steps_and_bells(place);
    EXPECT_EQ(library.terms().size(), 8U);
    for (const Term& term : library.terms()) {
        ASSERT_EQ(term.shapes.size(), 2U);
        for (const TermShape& shape : term.shapes) {
            EXPECT_GE(shape.value, shape.low);
            EXPECT_LE(shape.value, shape.high);
        }
    }
}

TEST(TermLibrary, LagAndDelay_RememberTheVariable) {
    TermLibrary library;
    const TermShape time{.unit = "s", .value = 0.0, .low = 1e-3, .high = 1.0};
    library.add_delayed(speed, time, std::vector{0.01, 0.1});
    library.add_lagging(speed, time, std::vector{0.05});
    ASSERT_EQ(library.terms().size(), 3U);
    ASSERT_TRUE(library.terms()[0].memory && library.terms()[2].memory);
    EXPECT_EQ(library.terms()[0].memory->kind, FormulaEffect::Memory::Kind::delay);
    EXPECT_EQ(library.terms()[2].memory->kind, FormulaEffect::Memory::Kind::state);
    EXPECT_DOUBLE_EQ(library.terms()[1].shapes.front().value, 0.1);
}

TEST(TermLibrary, VariableThatDidNotVary_HasNoShapedTerm) {
    TermLibrary library;
    library.add_knees("max(0, speed - shape)", still, "beyond a speed");
    EXPECT_TRUE(library.terms().empty());
}

}  // namespace
}  // namespace fidservo
