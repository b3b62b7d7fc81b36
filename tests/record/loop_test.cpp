// SPDX-License-Identifier: GPL-3.0-or-later
// The complete loop: a rig whose file is wrong is recorded and diagnosed; with the rig file that the
// diagnosis writes, new recordings have no gap.
#include "core/rig.h"
#include "gap/diagnose.h"
#include "src/diagnose/diagnosis_json.h"
#include "src/files/recording/reader.h"
#include "src/files/rig/rig_edit.h"
#include "src/files/rig/rig_file.h"
#include "src/record/record_experiments.h"
#include "tests/src/temporary_folder.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using testing::TemporaryFolder;

/// Recordings of a rig with hidden effects that is used with a rig file.
std::vector<Recording> pulses(const std::filesystem::path& rig_file, const std::filesystem::path& hidden,
                              const std::vector<std::uint64_t>& seeds, const std::filesystem::path& folder) {
    std::vector<Recording> recordings;
    for (const std::uint64_t seed : seeds) {
        ExperimentOptions options;
        options.session.rig_file = rig_file;
        options.session.sim_rig_file = hidden;
        options.session.seed = seed;
        options.experiment = "macro-pulses";
        options.out = folder / std::to_string(seed);
        EXPECT_TRUE(record_experiments(options));
        for (const std::filesystem::path& found : find_recordings(options.out))
            recordings.push_back(read_recording(found));
    }
    return recordings;
}

TEST(SlowLoop, HiddenPayload_IsNamed_AndGoneWithTheRigFileThatTheDiagnosisWrites) {
    const TemporaryFolder folder;
    const std::filesystem::path file = reference_rig_file(), hidden = folder.path() / "hidden.yaml",
                                corrected = folder.path() / "corrected.yaml";
    RigEdit edit(file);
    edit.state_effect({"payload", {{"mass_factor", 1.15}}});
    edit.save(hidden);

    const gap::Evidence first(load_rig(file), pulses(file, hidden, {11, 12}, folder.path()));
    const gap::Diagnosis diagnosis = gap::diagnose(first);
    EXPECT_EQ(diagnosis.verdict, gap::Verdict::explained);
    ASSERT_EQ(diagnosis.effects.size(), 1U);
    EXPECT_EQ(diagnosis.effects.front().effect, "payload");
    EXPECT_GT(diagnosis.effects.front().probability, 0.9);
    EXPECT_NEAR(diagnosis.effects.front().parameters.front().value, 1.15, 0.005);
    EXPECT_GT(diagnosis.gap.before, 10.0);

    write_diagnosed_rig(corrected, file, diagnosis);
    const gap::Evidence second(load_rig(corrected), pulses(corrected, hidden, {13, 14}, folder.path()));
    const gap::Diagnosis again = gap::diagnose(second);
    EXPECT_EQ(again.verdict, gap::Verdict::no_gap);
    EXPECT_LT(again.gap.before, 1.1);
}

}  // namespace
}  // namespace fidservo
