// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/identify/identified.h"

#include "core/rig.h"
#include "src/files/rig/rig_file.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace fidservo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TemporaryFolder;
using testing::text_of;

const std::filesystem::path reference = FIDSERVO_ASSETS_DIR "/rig.yaml";

Identified identified_macro() {
    return {.part = "macro",
            .recordings = {"macro-pulses-1"},
            .values = {{"macro.velocity_gain_mm_per_s_per_V", "mm/s/V", 201.5, 0.12},
                       {"macro.velocity_pole", "", 0.9571, 0.0002},
                       {"time_constant", "s", 0.0228, 0.0001, false}},
            .residuals = {{"encoder", "count", 0.31, 0.2887}},
            .undetermined = {{"macro.dead_zone.slope", "one amplitude only"}},
            .effects = {{"drive_offset", {{"offset_V", -0.09}}}},
            .fod = nullptr,
            .notes = {}};
}

TEST(IdentifiedRig, ValuesAndEffects_AreWhatTheNewFileReads) {
    const TemporaryFolder folder;
    write_identified_rig(folder / "new.yaml", reference, identified_macro());
    const Rig rig = load_rig(folder / "new.yaml");
    const Rig before = load_rig(reference);
    EXPECT_DOUBLE_EQ(rig.macro.velocity_gain_mm_per_s_per_V, 201.5);
    EXPECT_DOUBLE_EQ(rig.macro.velocity_pole, 0.9571);
    EXPECT_DOUBLE_EQ(rig.macro.dead_zone.slope, before.macro.dead_zone.slope);
    EXPECT_DOUBLE_EQ(rig.micro->fod->stroke_mm(), before.micro->fod->stroke_mm());
    ASSERT_EQ(rig.effects.size(), 1u);
    EXPECT_EQ(rig.effects[0].name, "drive_offset");
    EXPECT_DOUBLE_EQ(rig.effects[0].parameters.at(0).value, -0.09);
    EXPECT_THAT(text_of(folder / "new.yaml"),
                ::testing::AllOf(HasSubstr("macro.velocity_pole: 0.0002"), HasSubstr("encoder_count: 0.31")));
}

TEST(IdentifiedRig, WrittenAgain_ReplacesItsEffect) {
    const TemporaryFolder folder;
    Identified identified = identified_macro();
    write_identified_rig(folder / "first.yaml", reference, identified);
    identified.effects[0].parameters[0].value = 0.2;
    write_identified_rig(folder / "second.yaml", folder / "first.yaml", identified);
    const Rig rig = load_rig(folder / "second.yaml");
    ASSERT_EQ(rig.effects.size(), 1u);
    EXPECT_DOUBLE_EQ(rig.effects[0].parameters[0].value, 0.2);
}

TEST(IdentifiedRig, FodTable_IsWrittenBesideItAndReadBack) {
    const TemporaryFolder folder;
    const Rig before = load_rig(reference);
    Identified identified{.part = "hysteresis", .fod = before.micro->fod};
    write_identified_rig(folder / "new.yaml", reference, identified);
    const Rig rig = load_rig(folder / "new.yaml");
    const FodTable& table = *rig.micro->fod;
    ASSERT_EQ(table.nodes(), before.micro->fod->nodes());
    for (std::size_t peak = 0; peak < table.nodes(); ++peak)
        for (std::size_t temp = 0; temp <= peak; ++temp)
            EXPECT_NEAR(table.node_mm(peak, temp), before.micro->fod->node_mm(peak, temp), 5.1e-6);
    EXPECT_TRUE(std::filesystem::exists(folder / "new_fod.csv"));
}

TEST(IdentifiedRig, ExistingFile_IsNotOverwritten) {
    const TemporaryFolder folder;
    const auto file = folder.write("new.yaml", "mine");
    EXPECT_THAT(message_of([&] { write_identified_rig(file, reference, identified_macro()); }),
                HasSubstr("exists already"));
    EXPECT_EQ(text_of(file), "mine");
}

TEST(IdentifiedRig, ValueThatNoRigFileMayHold_LeavesNoFile) {
    const TemporaryFolder folder;
    Identified identified = identified_macro();
    identified.values[1].value = 1.2;
    EXPECT_THAT(message_of([&] { write_identified_rig(folder / "new.yaml", reference, identified); }),
                HasSubstr("macro.velocity_pole: 1.2"));
    EXPECT_FALSE(std::filesystem::exists(folder / "new.yaml"));
}

TEST(IdentifiedText, StandardErrors_SetTheDigits) {
    const std::string text = describe(identified_macro());
    EXPECT_THAT(text, HasSubstr("201.50 +- 0.12 mm/s/V"));
    EXPECT_THAT(text, HasSubstr("0.95710 +- 0.00020"));
    EXPECT_THAT(text, HasSubstr("encoder 0.31 count r.m.s. (noise and rounding: 0.2887)"));
    EXPECT_THAT(text, HasSubstr("not determined: macro.dead_zone.slope: one amplitude only"));
}

TEST(IdentifiedJson, Everything_IsInIt) {
    const TemporaryFolder folder;
    write_identification_json(folder / "new.json", identified_macro());
    const auto json = nlohmann::json::parse(text_of(folder / "new.json"));
    EXPECT_EQ(json["format"], "fidservo-identification/1");
    EXPECT_EQ(json["values"][0]["std"], 0.12);
    EXPECT_EQ(json["undetermined"][0]["key"], "macro.dead_zone.slope");
    EXPECT_EQ(json["effects"][0]["parameters"]["offset_V"], -0.09);
}

TEST(RigFileEffects, Mistakes_NameFileAndEffect) {
    const TemporaryFolder folder;
    const std::string rig = text_of(std::filesystem::path(FIDSERVO_ASSETS_DIR) / "rig.yaml");
    std::filesystem::copy_file(FIDSERVO_ASSETS_DIR "/preisach_fod.csv", folder / "preisach_fod.csv");
    const auto message = [&](const std::string& effects) {
        return message_of([&] { load_rig(folder.write("rig.yaml", rig + effects)); });
    };
    EXPECT_THAT(message("\neffects: [{name: airflo}]\n"), HasSubstr("no such effect; known: drive_gain"));
    EXPECT_THAT(message("\neffects: [{name: airflow, factor: 7}]\n"),
                HasSubstr("7 is out of bounds; allowed: 0.2 .. 3"));
    EXPECT_THAT(message("\neffects: [{factor: 7}]\n"), HasSubstr("name"));
    EXPECT_THAT(message("\neffects: [{name: payload}, {name: payload, mass_factor: 3}]\n"),
                HasSubstr("payload: is stated twice"));
}

TEST(IdentifiedRig, NothingForARigFile_IsSaid) {
    Identified identified{.part = "heater", .values = {{"time_constant", "s", 1.0, 0.1, false}}};
    EXPECT_FALSE(fits_a_rig_file(identified));
    identified.effects = {{"drive_offset", {}}};
    EXPECT_TRUE(fits_a_rig_file(identified));
}

}  // namespace
}  // namespace fidservo
