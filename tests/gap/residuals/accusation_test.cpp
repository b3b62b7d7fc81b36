// SPDX-License-Identifier: GPL-3.0-or-later
// Which block a pattern of errors accuses.
#include "gap/residuals/accusation.h"

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;

/// Floors of encoder, Hall reading and tags, and of the tags' motion along and across.
Pattern pattern(double encoder, double hall, double tag, double along, double across,
                std::optional<Signal> displacing = {}) {
    Pattern pattern{.floors = {}, .tag_along = along, .tag_across = across, .displacing = displacing};
    pattern.floors[index_of(Signal::encoder)] = encoder;
    pattern.floors[index_of(Signal::hall)] = hall;
    pattern.floors[index_of(Signal::tag)] = tag;
    return pattern;
}

TEST(Accusation, SensorThatReadsFalsely_SpoilsTheTagsAsWell) {
    const Pattern hall = pattern(0.4, 30.0, 30.0, 85.0, 1.0, Signal::hall);
    EXPECT_EQ(false_sensor(hall), Signal::hall);
    EXPECT_EQ(accused_block(hall, Signal::hall, Dependence::contraction), "micro.hall");
    const Pattern encoder = pattern(11.0, 1.0, 1900.0, 5300.0, 1.0, Signal::encoder);
    EXPECT_EQ(false_sensor(encoder), Signal::encoder);
    EXPECT_EQ(accused_block(encoder, Signal::encoder, Dependence::command), "macro.encoder");
}

TEST(Accusation, HallReadingThatDisplacesTags_IsFalse_ThoughTheCarriageIsOffAsWell) {
    const Pattern both = pattern(2.4, 39.0, 41.0, 116.0, 1.0, Signal::hall);
    EXPECT_EQ(false_sensor(both), Signal::hall);
    EXPECT_FALSE(tags_are_innocent(both));
    EXPECT_EQ(accused_block(both, Signal::hall, Dependence::platform_place), "micro.hall");
    EXPECT_EQ(accused_block(both, Signal::encoder, Dependence::velocity), "macro.friction");
}

TEST(Accusation, ActuatorSpoilsItsOwnPredictionOnly) {
    const Pattern wire = pattern(0.4, 334.0, 1.1, 1.3, 1.0);
    EXPECT_FALSE(false_sensor(wire).has_value());
    EXPECT_EQ(accused_block(wire, Signal::hall, Dependence::temperature), "micro.heater");
    EXPECT_EQ(accused_block(wire, Signal::hall, Dependence::direction), "micro.hysteresis");
    EXPECT_EQ(accused_block(wire, Signal::hall, Dependence::acceleration), "micro.mechanics");
    EXPECT_EQ(accused_block(wire, Signal::hall, Dependence::contraction_before), "micro.hysteresis");
    EXPECT_EQ(accused_block(wire, Signal::hall, Dependence::platform_place), "micro.mechanics");
    EXPECT_EQ(accused_block(wire, Signal::hall, Dependence::turns_of_wire), "micro.mechanics");
    EXPECT_EQ(accused_block(wire, Signal::hall, {}), "micro.heater");
}

TEST(Accusation, PlaceBetweenTwoCounts_IsNoFalseEncoder_AndNoCameraIsBlamed) {
    const Pattern friction = pattern(201.0, 1.0, 18.0, 50.0, 1.0);
    EXPECT_FALSE(false_sensor(friction).has_value());
    EXPECT_TRUE(tags_are_innocent(friction));
    EXPECT_EQ(accused_block(friction, Signal::encoder, Dependence::velocity), "macro.friction");
    EXPECT_EQ(accused_block(friction, Signal::encoder, Dependence::command_change), "macro.drive");
}

TEST(Accusation, CarriageThatIsMisplacedBetweenCounts_IsNoFalseEncoderEither_WhereBothAreLittleOff) {
    EXPECT_FALSE(false_sensor(pattern(20.9, 1.0, 10.1, 28.7, 1.0)).has_value());
    EXPECT_FALSE(false_sensor(pattern(8.3, 1.0, 4.0, 11.3, 1.0)).has_value());
}

TEST(Accusation, PeriodInTheReading_AccusesTheEncoder_IfTheTagsSaySoOrThereAreNone) {
    const Dependence ripple = Dependence::reading_period;
    EXPECT_EQ(accused_block(pattern(3.4, 1.0, 5.2, 14.7, 1.0, Signal::encoder), Signal::encoder, ripple),
              "macro.encoder");
    EXPECT_EQ(accused_block(pattern(3.4, 1.0, 1.0, 1.0, 1.0), Signal::encoder, ripple), "macro.mechanics");
    EXPECT_EQ(accused_block(pattern(3.4, 0.0, 0.0, 0.0, 0.0), Signal::encoder, ripple), "macro.encoder");
}

TEST(Accusation, TagsAlone_AccuseTheCamera) {
    const Pattern late = pattern(0.4, 1.0, 85.0, 240.0, 1.0), tilted = pattern(0.4, 1.0, 9.0, 12.0, 8.0);
    EXPECT_EQ(accused_block(late, Signal::tag, {}), "camera.timing");
    EXPECT_EQ(accused_block(tilted, Signal::tag, {}), "camera.geometry");
    EXPECT_EQ(accused_block(tilted, Signal::tag, Dependence::motion_by_row), "camera.image");
    EXPECT_FALSE(tags_are_innocent(late));
}

/// A sensor that reads falsely is off in its own prediction, too, unless an effect that is named makes up for
/// that.
TEST(Accusation, TagsThatDependOnTheContraction_AccuseTheHallSensor_UnlessItsReadingIsRight) {
    Pattern view = pattern(0.4, 1.0, 20.0, 57.0, 1.0);
    EXPECT_EQ(accused_block(view, Signal::tag, Dependence::contraction), "micro.hall");
    view.is_hall_right = true;
    EXPECT_EQ(accused_block(view, Signal::tag, Dependence::contraction), "camera.geometry");
}

TEST(Accusation, TagsThatAreDisplacedWhileNothingMoves_AreNoMatterOfTime) {
    Pattern displaced = pattern(0.4, 1.0, 8.2, 23.0, 1.0);
    displaced.tag_at_rest = 20.0;
    EXPECT_EQ(accused_block(displaced, Signal::tag, {}), "macro.encoder");
    EXPECT_EQ(accused_block(displaced, Signal::tag, Dependence::velocity), "camera.timing");
}

TEST(Accusation, TagsThatAreDisplacedAtRestByAShareOnly_AreAMatterOfTime) {
    Pattern late = pattern(0.4, 1.0, 146.0, 412.0, 1.0);
    late.tag_at_rest = 24.0;
    EXPECT_EQ(accused_block(late, Signal::tag, {}), "camera.timing");
}

TEST(Accusation, ShiftInTimeOfTheReadingAlone_AccusesTheSensor_OneOfTheWireTheHeater) {
    const Pattern drifting = pattern(0.4, 2.8, 1.0, 1.0, 1.0);
    EXPECT_EQ(accused_block(drifting, Signal::hall, Dependence::time), "micro.hall");
    EXPECT_EQ(accused_block(drifting, Signal::hall, Dependence::warmth_over_time), "micro.heater");
}

}  // namespace

}  // namespace fidservo
