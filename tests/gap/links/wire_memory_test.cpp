// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings that begin with a warm wire of unknown history.
#include "core/rig.h"
#include "gap/evidence.h"
#include "tests/gap/effects.h"
#include "tests/gap/root_mean_square.h"
#include "tests/gap/simulated_campaign.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::effects;
using testing::rms;

Recording recorded(std::string_view kind, const Hypothesis& truth, std::uint64_t seed) {
    const std::string name(kind);
    return simulate(reference_rig(), truth, make_experiment(kind, reference_rig(), seed, name), name, seed);
}

Recording from(Recording recording, std::size_t first) {
    recording.rows.erase(recording.rows.begin(), recording.rows.begin() + static_cast<std::ptrdiff_t>(first));
    std::erase_if(recording.detections, [&](const TagDetection& detection) {
        return detection.time_ns < recording.rows.front().time_ns;
    });
    return recording;
}

std::size_t hall_windows(const Evidence& evidence) {
    return static_cast<std::size_t>(std::ranges::count(evidence.windows(), Signal::hall, &Window::signal));
}

struct Beginning {
    std::string_view kind;
    std::size_t first;  ///< row of the original with which the recording begins
};

void PrintTo(const Beginning& beginning, std::ostream* stream) {
    *stream << beginning.kind << " from row " << beginning.first;
}

class WarmWire : public ::testing::TestWithParam<Beginning> {};

TEST_P(WarmWire, TruthIsAtTheFloor_AndOneOfItsEffectsIsSeen) {
    for (const std::uint64_t seed : {41, 42, 43}) {
        for (const std::string_view effect :
             {"airflow:factor=0.8", "ambient_temperature:shift_degC=4", "stroke_change:factor=0.95"}) {
            const Hypothesis truth = effects({effect});
            const Evidence evidence(reference_rig(),
                                    {from(recorded(GetParam().kind, truth, seed), GetParam().first)});
            ASSERT_GE(hall_windows(evidence), 5U) << effect << " seed " << seed;
            EXPECT_LT(rms(evidence, evidence.errors(truth, everything(evidence)), Signal::hall), 1.2)
                << effect << " seed " << seed;
            EXPECT_GT(rms(evidence, evidence.errors({}, everything(evidence)), Signal::hall), 3.0)
                << effect << " seed " << seed;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Starts, WarmWire,
                         ::testing::Values(Beginning{"micro-steps", 2500}, Beginning{"micro-steps", 4200},
                                           Beginning{"micro-triangle", 3300}, Beginning{"micro-servo", 4000},
                                           Beginning{"integrated", 5000}));

/// A wire that was heated and reads nearly as a cold one may occasionally be taken for a cold one: they only
/// differ in what follows, which is also different for a rig that differs from its file.
TEST(SlowWarmWire, NominalRig_IsAtTheFloor_WhereverItsRecordingBegins_ButOneInTwenty) {
    int all = 0, off = 0;
    for (const std::string_view kind : {"micro-triangle", "micro-steps", "micro-servo"}) {
        const Recording whole = recorded(kind, {}, 45);
        for (std::size_t first = 400; first < 8500; first += 450) {
            const Evidence evidence(reference_rig(), {from(whole, first)});
            ++all;
            off += rms(evidence, evidence.errors({}, everything(evidence)), Signal::hall) > 1.4 ? 1 : 0;
        }
    }
    EXPECT_LE(20 * off, all) << off << " of " << all;
}

TEST(WarmWire, ColdStart_IsJudgedFromItsFirstWindowOn_WhateverTheSensorsZero) {
    for (const std::string_view kind : {"micro-steps", "micro-servo", "macro-pulses", "rest"}) {
        const Evidence plain(reference_rig(), {recorded(kind, {}, 44)});
        const Evidence offset(reference_rig(), {recorded(kind, effects({"hall_offset"}), 44)});
        EXPECT_EQ(hall_windows(offset), hall_windows(plain)) << kind;
        EXPECT_EQ(offset.windows().front().first_row, plain.windows().front().first_row) << kind;
    }
}

}  // namespace

}  // namespace fidservo
