// SPDX-License-Identifier: GPL-3.0-or-later
// The carriage is predicted from the state in which a window finds it.
#include "gap/evidence.h"
#include "gap/fit/score.h"
#include "src/simulation/planned_experiments.h"
#include "src/simulation/simulate.h"
#include "tests/reference_rig.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fidservo::gap {
namespace {

/// The largest r.m.s. error of the encoder's windows, in floors, where the rig is what its file says.
double worst_window(const Rig& rig, const std::string& experiment) {
    const testing::TemporaryFolder folder;
    const PlannedExperiment planned = planned_experiment(folder.write("to-and-fro.yaml", experiment), rig, 1);
    const Evidence evidence(rig, {simulate(rig, {}, planned.experiment, planned.name, 1)});
    const std::vector<double> squares =
        mean_squares(evidence.windows(), evidence.errors({}, everything(evidence)));
    double worst = 0.0;
    for (std::size_t w = 0; w < squares.size(); ++w)
        if (evidence.windows()[w].signal == Signal::encoder) worst = std::max(worst, std::sqrt(squares[w]));
    return worst;
}

/// It stands two counts from the end of travel, where no row is judged, and breaks away slowly. Friction that
/// falls with the speed multiplies what the speed is off by where the first window begins.
TEST(CarriageBreakAway, BreakAwayBesideAnEndOfTravel_IsFollowedWithFrictionThatFalls) {
    Rig rig = reference_rig();
    rig.effects = {{"stribeck_friction", {{"level_V", 0.3}, {"speed_mm_per_s", 12.0}}}};
    for (const double V_per_s : {1.0, 2.0, 4.0})
        EXPECT_LT(worst_window(rig, fmt::format("name: to-and-fro\n"
                                                "carriage_mm: 199.9\n"
                                                "macro:\n"
                                                "  - {{ ramp_V: [-2.5, {}], duration_s: 0.5 }}\n"
                                                "  - {{ hold: last, duration_s: 0.3 }}\n"
                                                "  - {{ constant_V: -4, duration_s: 0.4 }}\n"
                                                "  - {{ constant_V: 0, duration_s: 2 }}\n",
                                                -2.5 - 0.5 * V_per_s)),
                  1.5)
            << V_per_s;
}

}  // namespace
}  // namespace fidservo::gap
