// SPDX-License-Identifier: GPL-3.0-or-later
// The staircase of relays: what Preisach's law promises, and the published sum (eq. 8) as another way to the
// same contraction.
#include "reference/preisach_plane.h"

#include "core/preisach.h"
#include "core/random.h"
#include "core/rig.h"
#include "src/files/rig/rig_file.h"

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo::reference {
namespace {

std::shared_ptr<const FodTable> table() {
    static const auto fod = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml").micro->fod;
    return fod;
}

double after(const PreisachPlane& plane, Staircase staircase, const std::vector<double>& path_degC) {
    for (const double temp_degC : path_degC) move_to(plane, staircase, temp_degC);
    return contraction_mm(plane, staircase);
}

TEST(PreisachPlane, TwoCellTable_HasTheMassesThatItsNodesGive) {
    // nodes 0, 1, 2 degC: f(1,0) = 1, f(1,1) = 3, f(2,0) = 2, f(2,1) = 7, f(2,2) = 12 mm
    const PreisachPlane plane(FodTable({0, 1, 2}, {0, 1, 3, 2, 7, 12}));
    EXPECT_DOUBLE_EQ(plane.strip_mm(0, 2, 2), 12.0);
    EXPECT_DOUBLE_EQ(plane.strip_mm(1, 2, 0), 1.0);  // always on in b: f(2,0) - f(1,0)
    EXPECT_DOUBLE_EQ(plane.strip_mm(1, 2, 1), 4.0);  // and the cell: 7 - 3 - 2 + 1 = 3
    EXPECT_DOUBLE_EQ(plane.strip_mm(1, 1.5, 0.5), 0.5 * (1.0 + 0.5 * 3.0));
    EXPECT_DOUBLE_EQ(plane.strip_mm(1, 2, 1.25), 4.0 + 0.25 * 5.0);  // a quarter of the line's 12 - 7
    EXPECT_DOUBLE_EQ(plane.strip_mm(1.5, 2, 1.25), 2.0);             // of which none is above 1.5
}

TEST(PreisachPlane, FirstOrderDescendingCurves_AreTheTable) {
    const PreisachPlane plane(*table());
    for (double peak = 10.0; peak <= 120.0; peak += 0.7)
        for (double temp = 10.0; temp <= peak; temp += 0.9)
            ASSERT_NEAR(after(plane, heated_to(plane, 10.0), {peak, temp}),
                        table()->contraction_mm(peak, temp), 1e-12)
                << peak << " " << temp;
}

TEST(PreisachPlane, PassedExtrema_AreWipedOut) {
    const PreisachPlane plane(*table());
    const Staircase start = heated_to(plane, 22.0);
    for (const double end : {95.0, 97.3, 110.0})
        EXPECT_NEAR(after(plane, start, {90, 40, 80, 50, 70, 60, 66, end}), after(plane, start, {end}),
                    1e-12);
    EXPECT_NEAR(after(plane, start, {90, 40, 80, 50, 70, 60, 85}), after(plane, start, {90, 40, 85}), 1e-12);
    EXPECT_NEAR(after(plane, start, {90, 40, 80, 50, 70, 45}), after(plane, start, {90, 40, 80, 45}), 1e-12);
    Staircase deep = start;
    for (const double temp : {90.0, 40.0, 80.0, 50.0, 70.0, 60.0}) move_to(plane, deep, temp);
    EXPECT_EQ(deep.stairs.size(), 3u);
    move_to(plane, deep, 90.0);
    EXPECT_EQ(deep.stairs.size(), 1u);
}

TEST(PreisachPlane, MinorLoops_BetweenTheSameTemperaturesAreCongruent) {
    const PreisachPlane plane(*table());
    const std::vector<double> heating{64, 67.5, 71, 75};
    const std::vector<double> outer_peaks{82, 90, 101, 118};
    for (const double temp : heating) {
        std::vector<double> shapes;
        for (const double peak : outer_peaks) {
            const Staircase start = heated_to(plane, 22.0);
            shapes.push_back(after(plane, start, {peak, 60, temp}) - after(plane, start, {peak, 60}));
        }
        for (const double shape : shapes) EXPECT_NEAR(shape, shapes.front(), 1e-12) << temp;
    }
    // and they close
    const Staircase start = heated_to(plane, 22.0);
    EXPECT_NEAR(after(plane, start, {100, 60, 75, 60}), after(plane, start, {100, 60}), 1e-12);
}

TEST(PreisachPlane, RandomPaths_AgreeWithThePublishedSum) {
    const PreisachPlane plane(*table());
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        NoiseStream draw(seed, "path");
        Staircase staircase = heated_to(plane, 22.0);
        PreisachMemory memory = preisach_start(*table(), 22.0);
        double temp_degC = 22.0;
        for (int k = 0; k < 5000; ++k) {
            // now and then a leap, beyond the table too; otherwise a walk that nests and wipes
            temp_degC =
                draw.uniform() < 0.02 ? -5.0 + 140.0 * draw.uniform() : temp_degC + 6.0 * draw.normal();
            move_to(plane, staircase, temp_degC);
            ASSERT_NEAR(contraction_mm(plane, staircase), preisach_step(*table(), memory, temp_degC), 1e-9)
                << k;
        }
    }
}

}  // namespace
}  // namespace fidservo::reference
