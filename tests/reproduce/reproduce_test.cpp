// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/reproduce/reproduce.h"

#include "core/rig.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::reproduce {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TemporaryFolder;
using testing::text_of;

const std::filesystem::path assets = FIDSERVO_ASSETS_DIR;

TEST(SlowReproduce, ReferenceRig_NoClaimFailsAndDifferencesSayWhy) {
    const TemporaryFolder folder;
    const auto claims = reproduce(assets / "rig.yaml", folder.path(), 3);
    EXPECT_GE(claims.size(), 10u);
    for (const Claim& claim : claims) {
        EXPECT_NE(claim.outcome, Outcome::fails) << claim.claim << ": " << claim.measured;
        EXPECT_EQ(claim.outcome == Outcome::rig_differs,
                  claim.outcome != Outcome::holds && !claim.why.empty());
        EXPECT_FALSE(claim.measured.empty());
    }
    const std::string report = text_of(folder / "report.html");
    EXPECT_EQ(report.find("http://"), std::string::npos) << "a report loads nothing";
    EXPECT_THAT(text_of(folder / "claims.csv"), HasSubstr("source,claim,measured,outcome,why\n"));
}

/// A rig that cannot do what is claimed: the table must say so.
TEST(SlowReproduce, SluggishHeater_FailsTheSettlingClaim) {
    const TemporaryFolder folder;
    std::string text = text_of(assets / "rig.yaml");
    const std::string piece = "heating_tau_s: 0.55";
    text.replace(text.find(piece), piece.size(), "heating_tau_s: 2.50");
    std::filesystem::copy_file(assets / "preisach_fod.csv", folder / "preisach_fod.csv");
    const auto claims = reproduce(folder.write("rig.yaml", text), folder / "out", 3);
    const auto settling =
        std::ranges::find_if(claims, [](const Claim& claim) { return claim.claim.starts_with("250 ms"); });
    ASSERT_NE(settling, claims.end());
    EXPECT_EQ(settling->outcome, Outcome::fails);
}

TEST(Reproduce, RigWithoutAPublishedPart_IsRefused) {
    const TemporaryFolder folder;
    const auto rig =
        folder.write("rig.yaml",
                     "name: bare\ntick_s: 0.001\nmacro:\n  travel_mm: [0, 200]\n  command_limit_V: 5\n"
                     "  velocity_gain_mm_per_s_per_V: 200\n  velocity_pole: 0.95\n"
                     "  encoder_resolution_mm: 0.05\n");
    EXPECT_THAT(message_of([&] { reproduce(rig, folder / "out", 1); }), HasSubstr("macro.pd: missing"));
}

}  // namespace
}  // namespace fidservo::reproduce
