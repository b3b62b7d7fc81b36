// SPDX-License-Identifier: GPL-3.0-or-later
// The quantity on which a carriage's errors depend if it is driven or braked by a law that is no effect of
// the catalogue.
#include "core/dead_zone.h"
#include "core/rig.h"
#include "gap/diagnose.h"
#include "gap/residuals/held_carriage.h"
#include "tests/gap/simulated_campaign.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using ::testing::HasSubstr;

/// The state of a carriage.
struct Carriage {
    double place_mm, velocity_mm_per_s, way_mm, stood_s;
};

/// The forces at a command: the drive's, and dry friction.
struct Forces {
    double drive_V, friction_V;
};

double push_V(double command_V) {
    return dead_zone_V(reference_rig().macro.dead_zone, command_V);
}

/// Moves on by a tick: tau dv/dt + v = K f.
void advance(Carriage& carriage, const std::function<Forces(const Carriage&)>& forces) {
    constexpr int steps = 50;
    const MacroParameters& macro = reference_rig().macro;
    const double tick_s = reference_rig().tick_s, step_s = tick_s / steps;
    const double tau_s = -tick_s / std::log(macro.velocity_pole);
    for (int step = 0; step < steps; ++step) {
        const auto [drive_V, friction_V] = forces(carriage);
        double& velocity = carriage.velocity_mm_per_s;
        carriage.stood_s = velocity == 0.0 ? carriage.stood_s + step_s : 0.0;
        if (velocity == 0.0 && std::abs(drive_V) <= friction_V) continue;
        const double direction = velocity != 0.0 ? velocity : drive_V;
        const double force_V = drive_V - (friction_V > 0.0 ? std::copysign(friction_V, direction) : 0.0);
        const double next =
            velocity + step_s / tau_s * (macro.velocity_gain_mm_per_s_per_V * force_V - velocity);
        velocity = friction_V > 0.0 && next * direction < 0.0 ? 0.0 : next;
        carriage.place_mm += step_s * velocity;
        carriage.way_mm += step_s * std::abs(velocity);
    }
}

/// Recordings of commands in open loop, without tags, of a carriage on which other forces act.
std::vector<Recording> recordings_under(const std::function<Forces(double, const Carriage&)>& forces) {
    std::vector<Recording> recordings = testing::recordings_of({}, {"macro-sweep", "macro-pulses"});
    const double resolution_mm = reference_rig().macro.encoder_resolution_mm;
    for (Recording& recording : recordings) {
        recording.detections.clear();
        Carriage carriage{resolution_mm * recording.rows.front().encoder_count, 0.0, 0.0, 1.0};
        for (StageRow& row : recording.rows) {
            row.encoder_count = std::round(carriage.place_mm / resolution_mm);
            advance(carriage, [&](const Carriage& now) { return forces(row.macro_command_V, now); });
        }
    }
    return recordings;
}

/// @param dependence  the expected first quantity on which the errors depend
void expect_accused(const std::function<Forces(double, const Carriage&)>& forces,
                    const std::string& dependence, const std::string& block) {
    const Diagnosis diagnosis = diagnose(Evidence(reference_rig(), recordings_under(forces)),
                                         {.only = {"clock_skew"}, .without = {}, .selection = {}});
    ASSERT_TRUE(diagnosis.unexplained.has_value());
    ASSERT_FALSE(diagnosis.unexplained->depends_on.empty());
    EXPECT_THAT(diagnosis.unexplained->depends_on.front(), HasSubstr(dependence));
    EXPECT_EQ(diagnosis.where.front().block, block);
}

TEST(SurrogateOfCarriage, StepsOfAConverter_AccuseTheDrive) {
    constexpr double step_V = 0.25;
    expect_accused(
        [](double command_V, const Carriage&) {
            return Forces{push_V(step_V * std::round(command_V / step_V)), 0.0};
        },
        "command, periodic", "macro.drive");
}

TEST(SurrogateOfCarriage, PulleyThatRunsOutOfTrue_AccusesTheMechanics) {
    constexpr double share = 0.05, turn_mm = 25.4, phase_rad = 1.0;
    expect_accused(
        [](double command_V, const Carriage& at) {
            const double wave = std::sin(2.0 * std::numbers::pi * at.place_mm / turn_mm + phase_rad);
            return Forces{push_V(command_V) * (1.0 + share * wave), 0.0};
        },
        "times the drive's force", "macro.mechanics");
}

TEST(SurrogateOfCarriage, FrictionThatRunsIn_AccusesTheFriction) {
    constexpr double at_first_V = 0.3, way_mm = 300.0;
    expect_accused(
        [](double command_V, const Carriage& at) {
            return Forces{push_V(command_V), at_first_V * std::exp(-at.way_mm / way_mm)};
        },
        "against the motion", "macro.friction");
}

Forces with_stiction(double command_V, const Carriage& at) {
    constexpr double most_V = 0.8, dwell_s = 0.4;
    return {push_V(command_V),
            at.velocity_mm_per_s == 0.0 ? most_V * -std::expm1(-at.stood_s / dwell_s) : 0.0};
}

TEST(SurrogateOfCarriage, FrictionThatOnlyHolds_AccusesTheFriction) {
    expect_accused(with_stiction, "stands or slides", "macro.friction");
}

TEST(SlowHeldCarriage, IsToldFromOneThatPlayInertiaOrASmallForceKeeps) {
    EXPECT_TRUE(carriage_is_held({reference_rig(), recordings_under(with_stiction)}));
    for (const std::string_view effect : {"", "backlash", "payload", "belt_compliance", "drive_delay",
                                          "cogging:amplitude_V=0.002,period_mm=4,phase_rad=1"}) {
        const Hypothesis truth = effect.empty() ? Hypothesis{} : testing::effects({effect});
        EXPECT_FALSE(carriage_is_held(
            testing::campaign(truth, {"macro-sweep", "macro-pulses", "macro-square", "integrated"})))
            << effect;
    }
}

}  // namespace

}  // namespace fidservo
