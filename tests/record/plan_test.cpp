// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/record/plan.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "src/files/rig/plate_file.h"
#include "src/files/rig/rig_file.h"
#include "src/record/campaign_file.h"
#include "src/record/foresight.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using testing::message_of;
using testing::TemporaryFolder;

ExperimentOptions options_for(const std::string& experiment, const std::filesystem::path& out = "out") {
    ExperimentOptions options;
    options.session.rig_file = reference_rig_file();
    options.session.seed = 3;
    options.experiment = experiment;
    options.out = out;
    return options;
}

RecordPlan plan(const ExperimentOptions& options, const Rig& rig) {
    return plan_recordings(options, rig, plate_of(rig.fiducials.value()));
}

const Rig& reference() {
    static const Rig rig = load_rig(reference_rig_file());
    return rig;
}

TEST(RecordPlan, Campaign_HasTheNamesAndTheExcitationOfSimulate) {
    const RecordPlan planned = plan(options_for("campaign"), reference());
    const std::vector<CampaignRun> simulated = campaign_runs(reference());
    EXPECT_TRUE(planned.left_out.empty());
    ASSERT_EQ(planned.runs.size(), simulated.size());
    for (std::size_t k = 0; k < simulated.size(); ++k) {
        const PlannedRun& run = planned.runs[k];
        EXPECT_EQ(run.name, simulated[k].name);
        EXPECT_EQ(run.folder, std::filesystem::path("out") / run.name);
        const Experiment same = make_experiment(simulated[k].kind, reference(), 3, simulated[k].name);
        EXPECT_EQ(run.experiment.carriage_mm, same.carriage_mm);
        if (!same.macro_V) continue;
        for (const double t_s : {0.0, 0.3, 1.0, 5.5})
            EXPECT_EQ(run.experiment.macro_V(t_s), same.macro_V(t_s));
    }
}

TEST(RecordPlan, OneExperiment_IsTheFirstOfItsKind) {
    const RecordPlan planned = plan(options_for("macro-sweep", "somewhere"), reference());
    ASSERT_EQ(planned.runs.size(), 1u);
    EXPECT_EQ(planned.runs[0].name, "macro-sweep-1");
    EXPECT_EQ(planned.runs[0].folder, "somewhere");
    const Experiment same = make_experiment("macro-sweep", reference(), 3, "macro-sweep-1");
    EXPECT_EQ(planned.runs[0].experiment.macro_V(1.7), same.macro_V(1.7));
}

TEST(RecordPlan, FileOfOnesOwn_IsRecordedUnderItsName) {
    const RecordPlan planned = plan(options_for(FIDSERVO_ASSETS_DIR "/demo/slow-ramp.yaml"), reference());
    ASSERT_EQ(planned.runs.size(), 1u);
    EXPECT_EQ(planned.runs[0].name, "slow-ramp-1");
}

TEST(RecordPlan, DrawThatWouldLeaveTheTravel_IsDrawnAgain) {
    ExperimentOptions options = options_for("macro-sweep");
    options.session.seed = 1;
    const Experiment refused = make_experiment("macro-sweep", reference(), 1, "macro-sweep-1");
    ASSERT_TRUE(why_not(reference(), refused, std::nullopt));
    const RecordPlan planned = plan(options, reference());
    ASSERT_EQ(planned.runs.size(), 1u);
    EXPECT_EQ(planned.runs[0].name, "macro-sweep-1");
    EXPECT_FALSE(why_not(reference(), planned.runs[0].experiment, std::nullopt));
    options.experiment = "campaign";
    EXPECT_TRUE(plan(options, reference()).left_out.empty());
}

TEST(RecordPlan, TravelTooShort_IsRefusedAndLeftOutOfACampaign) {
    Rig rig = reference();
    rig.macro.high_mm = 40.0;
    EXPECT_EQ(
        message_of([&] { plan(options_for("macro-sweep"), rig); })
            .find("macro-sweep: the rig reference-rig cannot do it: from 20.0 mm the carriage would leave "
                  "its travel, 0 to 40 mm, after "),
        0u);
    const RecordPlan planned = plan(options_for("campaign"), rig);
    const auto is_sweep = [](const auto& text) { return text.starts_with("macro-sweep-"); };
    EXPECT_TRUE(std::ranges::none_of(planned.runs, is_sweep, &PlannedRun::name));
    EXPECT_EQ(std::ranges::count_if(planned.left_out, is_sweep), 2);
    EXPECT_FALSE(planned.runs.empty());
}

TEST(RecordPlan, WireThatWouldBeTooHot_IsForeseen) {
    const HeaterParameters& heater = reference().micro->heater;
    const Experiment held{
        .kind = "hot", .duration_s = 10.0, .carriage_mm = 100.0, .micro_V = [](double) { return 1.6; }};
    const double end_degC = heater.ambient_degC + heater.gain_degC_per_V * (1.6 - heater.onset_V);
    EXPECT_FALSE(why_not(reference(), held, std::nullopt));
    EXPECT_FALSE(why_not(reference(), held, end_degC + 0.1));
    const auto why = why_not(reference(), held, end_degC - 1.0);
    ASSERT_TRUE(why);
    EXPECT_EQ(why->find("the wire would be at 104 degC; allowed: 103"), 0u) << *why;
}

TEST(RecordPlan, RigFileThatStatesAnEffectOfTheCamera_IsForeseen) {
    Rig rig = reference();
    rig.effects.push_back({"pixel_scale", {{"factor", 1.03}}});
    EXPECT_EQ(why_not(rig, make_experiment("macro-square", rig, 3, "macro-square-1"), std::nullopt),
              std::nullopt);
}

TEST(RecordPlan, RigThatCannotBeHomed_IsRefused) {
    Rig rig = reference();
    rig.fiducials->columns = 1;  // at 0 mm, lower than anything that the camera can see while homing
    EXPECT_NE(
        message_of([&] { plan(options_for("rest"), rig); }).find("fiducials: none can be brought into view"),
        std::string::npos);
    rig = reference();
    rig.micro.reset();
    EXPECT_EQ(message_of([&] { plan_recordings(options_for("rest"), rig, {}); }),
              "rig reference-rig: micro: missing; positioning needs it");
}

TEST(RecordPlan, WhatIsThereWhole_IsNotMadeAgain) {
    const TemporaryFolder folder;
    const auto options = options_for("campaign", folder.path());
    const RecordPlan planned = plan(options, reference());
    const std::string keys = "format: fidservo-recording/1\nname: a\nrig: r\ntick_s: 0.001\n";
    folder.write("rest-1/recording.yaml", keys + "experiment: rest\nfinished: true\n");
    folder.write("rest-2/recording.yaml", keys + "experiment: rest\nfinished: false\n");
    folder.write("macro-pulses-1/stage0/data.csv", "");
    const auto missing = missing_runs(planned);
    ASSERT_EQ(missing.size(), planned.runs.size() - 1);
    EXPECT_EQ(missing[0].name, "rest-2");
    EXPECT_EQ(missing[1].name, "macro-pulses-1");
    folder.write("rest-1/recording.yaml", keys + "experiment: integrated\nfinished: true\n");
    EXPECT_NE(
        message_of([&] { missing_runs(planned); }).find("integrated: is not what is to be recorded, rest"),
        std::string::npos);
}

TEST(RecordPlan, ExpectedTime_IsAtLeastThatOfTheRecordings) {
    const RecordPlan planned = plan(options_for("campaign"), reference());
    double recorded_s = 0.0;
    for (const PlannedRun& run : planned.runs) recorded_s += run.experiment.duration_s;
    EXPECT_GT(expected_s(planned.runs, reference()), recorded_s + 8 * 10.0)
        << "eight of them begin after heat";
}

TEST(CampaignFile, OtherSeed_IsRefused) {
    const TemporaryFolder folder;
    auto options = options_for("campaign", folder.path());
    EXPECT_NE(message_of([&] { demand_same_campaign(options); }).find("there is no campaign to resume here"),
              std::string::npos);
    begin_campaign(options);
    EXPECT_NO_THROW(demand_same_campaign(options));
    options.session.seed = 4;
    EXPECT_NE(message_of([&] {
                  demand_same_campaign(options);
              }).find("seed: the campaign was begun with 3; now it is 4"),
              std::string::npos);
}

}  // namespace
}  // namespace fidservo
