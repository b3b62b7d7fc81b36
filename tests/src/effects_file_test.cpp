// SPDX-License-Identifier: GPL-3.0-or-later
// Effects as formulas in files: reading restores what was written, and errors are reported with their place.
#include "src/files/rig/effects_file.h"

#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"
#include "plant/formulas/port.h"
#include "src/files/rig/rig_edit.h"
#include "src/files/rig/rig_file.h"
#include "tests/src/message_of.h"
#include "tests/src/run_program.h"
#include "tests/src/temporary_folder.h"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TemporaryFolder;
using testing::text_of;

constexpr const char* two_effects = R"yaml(format: fidservo-effects/1
effects:
  - name: air_drag
    block: macro.friction
    acts_on: macro.friction
    formula: "drag * speed * abs(speed)"
    parameters:
      drag: {unit: V s2/mm2, bounds: [0, 1e-4], typical: 5.0e-6, text: per square of the speed}
    text: The carriage pushes air aside.
    source: Landau, Lifshitz, Fluid Mechanics
  - name: sticky_cable
    block: macro.mechanics
    acts_on: macro.force
    formula: -k * (stretched + late) * (1 + hard * stretched^2)
    parameters:
      k: {unit: V/mm, bounds: [0, 0.1], typical: 0.01}
      hard: {unit: 1/mm2, bounds: [0, 1], typical: 0, role: optional}
      wide: {unit: mm, bounds: [0.1, 50], typical: 5, role: shape, starts: [1, 20]}
    state:
      warm: (abs(speed) - warm) / 30
    play:
      stretched: {of: place - 100, width: wide}
    delay:
      late: {of: 0.001 * place + 0 * warm, by: 0.01 * wide}
)yaml";

std::string mistake(std::string text, const std::string& piece, const std::string& replacement) {
    const auto at = text.find(piece);
    EXPECT_NE(at, std::string::npos) << piece;
    text.replace(at, piece.size(), replacement);
    const TemporaryFolder folder;
    return message_of([&] { (void)load_effects_file(folder.write("effects.yaml", text)); });
}

TEST(EffectsFile, TwoEffects_AreReadWholly) {
    const TemporaryFolder folder;
    const auto effects = load_effects_file(folder.write("effects.yaml", two_effects));
    ASSERT_EQ(effects.size(), 2u);
    EXPECT_EQ(effects[0]->name, "air_drag");
    EXPECT_EQ(effects[0]->source, "Landau, Lifshitz, Fluid Mechanics");
    ASSERT_EQ(effects[0]->parameters.size(), 1u);
    EXPECT_EQ(effects[0]->parameters[0].unit, "V s2/mm2");
    EXPECT_EQ(effects[0]->parameters[0].high, 1e-4);
    EXPECT_EQ(effects[0]->parameters[0].vanishing, 0.0);
    EXPECT_EQ(effects[0]->parameters[0].typical, 5e-6);
    EXPECT_EQ(effects[1]->parameters[1].role, plant::Role::optional);
    EXPECT_EQ(effects[1]->parameters[2].vanishing, 5.0) << "a shape has nothing at which it vanishes";
    EXPECT_THAT(effects[1]->parameters[2].starts, ::testing::ElementsAre(1.0, 20.0));
    EXPECT_TRUE(effects[1]->needs_place);
    EXPECT_FALSE(effects[0]->needs_place);
    const FormulaEffect& text = effects[1]->formula->effect();
    ASSERT_EQ(text.memories.size(), 3u);
    EXPECT_EQ(text.memories[0].name, "warm");
    EXPECT_EQ(text.memories[1].of, "place - 100");
    EXPECT_EQ(text.memories[2].by, "0.01 * wide");
}

TEST(EffectsFile, Mistakes_AreNamedWithFileLineKeyAndWhatIsAllowed) {
    EXPECT_THAT(
        mistake(two_effects, "drag * speed", "drag * velocity"),
        ::testing::AllOf(HasSubstr("effects.yaml:6: effects[0].formula: "),
                         HasSubstr("character 8: \"velocity\" is not known here; allowed: time, command")));
    EXPECT_THAT(mistake(two_effects, "acts_on: macro.friction", "acts_on: macro.brake"),
                ::testing::AllOf(HasSubstr("effects.yaml:5: effects[0].acts_on: macro.brake: "),
                                 HasSubstr("allowed: macro.drive_voltage, ")));
    EXPECT_THAT(mistake(two_effects, "block: macro.friction", "block: micro.hall"),
                HasSubstr("effects.yaml:4: effects[0].block: micro.hall: "));
    EXPECT_THAT(mistake(two_effects, "bounds: [0, 1e-4]", "bounds: [1e-4, 0]"),
                ::testing::AllOf(HasSubstr("effects.yaml:8: effects[0].parameters.drag.bounds: "),
                                 HasSubstr("low is 0.0001, high 0; allowed: two finite numbers")));
    EXPECT_THAT(mistake(two_effects, "bounds: [0, 1e-4]", "bounds: [1e-6, 1e-4]"),
                HasSubstr("its vanishing value, 0, is out of its bounds; allowed: 1e-06 .. 0.0001"));
    EXPECT_THAT(mistake(two_effects, "typical: 5.0e-6", "typical: 5.0"), HasSubstr("allowed: 0 .. 0.0001"));
    EXPECT_THAT(mistake(two_effects, "role: shape", "role: form"),
                HasSubstr("effects[1].parameters.wide.role"));
    EXPECT_THAT(mistake(two_effects, "name: sticky_cable", "name: air_drag"),
                HasSubstr("name of two effects"));
    EXPECT_THAT(mistake(two_effects, "name: air_drag", "name: cogging"), HasSubstr("listed effect"));
    for (const char* name : {"\"a:b=c,d\"", "air drag", "\"air,drag\""})
        EXPECT_THAT(mistake(two_effects, "name: air_drag", std::string("name: ") + name),
                    ::testing::AllOf(HasSubstr("effects.yaml:3: effects[0].name: "),
                                     HasSubstr("allowed: letters, digits, _, - and .")));
    EXPECT_THAT(mistake(two_effects, "by: 0.01 * wide", "by: 3 * wide"),
                HasSubstr("effects[1].delay.late.by: 3 * wide: is 15 s with k = 0.01, hard = 0, wide = 5; "
                          "allowed: 0 to 10 s"));
    EXPECT_THAT(mistake(two_effects, "width: wide", "width: -wide"),
                HasSubstr("effects[1].play.stretched.width: -wide: is -5 with "));
    EXPECT_THAT(mistake(two_effects, "fidservo-effects/1", "fidservo-effects/9"),
                HasSubstr("fidservo-effects/1"));
    EXPECT_THAT(mistake(two_effects, "width: wide", "by: wide"), HasSubstr("by"));
    EXPECT_THAT(mistake(two_effects, "warm: (abs", "warm: (ab"), HasSubstr("effects[1].state.warm"));
    EXPECT_THAT(mistake(two_effects, "typical: 5.0e-6", "typical: 5.0e-6, value: 1.0e-6"),
                HasSubstr("value"));
    EXPECT_THAT(
        mistake(two_effects, "drag * speed", "drag \u2212 speed"),
        HasSubstr("effects[0].formula: drag \u2212 speed * abs(speed): character 6: \"\u2212\" has no "
                  "meaning here; allowed: numbers"));
    EXPECT_THAT(mistake(two_effects, "drag * speed", "drag\\0 * speed"),
                HasSubstr("character 5: a control character has no meaning here"));
}

TEST(EffectsFile, FormulaThatARigFileStates_IsReplacedByItsRefit) {
    const TemporaryFolder folder;
    const auto effects = load_effects_file(folder.write("effects.yaml", two_effects));
    RigEdit edit(std::filesystem::path(FIDSERVO_ASSETS_DIR) / "rig.yaml");
    edit.state_effect(plant::stated({effects[0], {2e-6}}));
    edit.save(folder / "rig.yaml");
    const Rig rig = load_rig(folder / "rig.yaml");
    const plant::Effect& refit = plant::refit_of(rig.effects[0]);
    EXPECT_EQ(&refit, &plant::refit_of(rig.effects[0])) << "made once";
    EXPECT_EQ(refit.name, "air_drag");
    EXPECT_EQ(refit.parameters[0].vanishing, 2e-6);
    EXPECT_DOUBLE_EQ(refit.parameters[0].typical, 2.4e-6);
    plant::PlantParameters parameters = plant::plant_parameters(rig);
    plant::put(refit, parameters, std::vector{7e-6});
    std::array<double, plant::carriage_variable::count> at{};
    at[plant::carriage_variable::speed] = 100.0;
    EXPECT_DOUBLE_EQ(parameters.axis.formulas.value(plant::Port::friction, at, {}), 7e-6 * 1e4);
    RigEdit again(folder / "rig.yaml");
    again.add_effect(plant::stated({&refit, {7e-6}}));
    again.save(folder / "new.yaml");
    const Rig changed = load_rig(folder / "new.yaml");
    ASSERT_EQ(changed.effects.size(), 1u);
    EXPECT_EQ(plant::setting_of(changed.effects[0]).values[0], 7e-6);
}

TEST(EffectsFile, StatedInARigFile_IsReadBackAsItWasWritten) {
    const TemporaryFolder folder;
    const auto effects = load_effects_file(folder.write("effects.yaml", two_effects));
    RigEdit edit(std::filesystem::path(FIDSERVO_ASSETS_DIR) / "rig.yaml");
    for (const plant::Effect* effect : effects) {
        StatedEffect stated{std::string(effect->name), {}, effect->formula->effect()};
        for (const plant::EffectParameter& parameter : effect->parameters)
            stated.parameters.push_back(
                {std::string(parameter.name), 0.7 * parameter.typical + 0.3 * parameter.high});
        edit.state_effect(stated);
        edit.state_effect(stated);
    }
    edit.save(folder / "rig.yaml");
    const Rig rig = load_rig(folder / "rig.yaml");
    ASSERT_EQ(rig.effects.size(), 2u) << "one of the same name is replaced";
    for (std::size_t k = 0; k < 2; ++k) {
        ASSERT_TRUE(rig.effects[k].formula.has_value());
        EXPECT_EQ(*rig.effects[k].formula, effects[k]->formula->effect());
        const plant::EffectSetting setting = plant::setting_of(rig.effects[k]);
        EXPECT_EQ(setting.effect, effects[k]);
        for (std::size_t p = 0; p < setting.values.size(); ++p)
            EXPECT_NEAR(setting.values[p],
                        0.7 * effects[k]->parameters[p].typical + 0.3 * effects[k]->parameters[p].high,
                        1e-9 * effects[k]->parameters[p].high);
    }
    EXPECT_TRUE(plant::plant_parameters(rig).axis.formulas.act(plant::Port::friction));
}

TEST(EffectsFile, ParameterInARigFile_HasItsTypicalValueWhereNoneIsGiven) {
    const TemporaryFolder folder;
    std::string entries = two_effects;
    entries = entries.substr(entries.find("  - name"));
    entries.replace(entries.find("typical: 5.0e-6"), 15, "typical: 5.0e-6, value: 2.0e-6");
    const auto assets = std::filesystem::path(FIDSERVO_ASSETS_DIR);
    std::filesystem::copy_file(assets / "preisach_fod.csv", folder / "preisach_fod.csv");
    const Rig rig =
        load_rig(folder.write("rig.yaml", text_of(assets / "rig.yaml") + "\neffects:\n" + entries));
    EXPECT_EQ(plant::setting_of(rig.effects[0]).values[0], 2e-6);
    EXPECT_EQ(plant::setting_of(rig.effects[1]).values[0], 0.01);
}

/// The values decide whether a delay can be, and what a formula gives: both are known only with them.
TEST(EffectsFile, ValuesOfARigFileThatNoMachineHas_AreNamedWithFileLineAndKey) {
    const TemporaryFolder folder;
    const auto rig_with = [&](const char* value) {
        const std::string entry = fmt::format(
            "\neffects:\n  - name: late_drag\n    block: macro.friction\n    acts_on: macro.friction\n"
            "    formula: 10 * d * late\n    parameters:\n"
            "      d: {{bounds: [0, 100], typical: 0.1, value: {}}}\n"
            "    delay: {{late: {{of: command, by: d}}}}\n",
            value);
        const auto file = folder.write(
            "rig.yaml", text_of(std::filesystem::path(FIDSERVO_ASSETS_DIR) / "rig.yaml") + entry);
        std::filesystem::copy_file(std::filesystem::path(FIDSERVO_ASSETS_DIR) / "preisach_fod.csv",
                                   folder / "preisach_fod.csv",
                                   std::filesystem::copy_options::overwrite_existing);
        return file;
    };
    EXPECT_THAT(message_of([&] { (void)load_rig(rig_with("20")); }),
                ::testing::ContainsRegex("rig.yaml:[0-9]+: effects.0..delay.late.by: d: is 20 s with d = 20; "
                                         "allowed: 0 to 10 s"));
    const Rig rig = load_rig(rig_with("9"));
    EXPECT_THAT(message_of([&] {
                    const plant::StagePlant plant = plant::make_stage_plant(rig);
                    plant::StageState state = plant::start(plant, 50.0, 1);
                    for (int tick = 0; tick < 10'000; ++tick) plant::advance(plant, state, 4.0, 0.0);
                }),
                ::testing::ContainsRegex("rig.yaml:[0-9]+: effects.0..formula: gives [0-9.]+ V"));
}

TEST(EffectsFile, WhatAFormulaGivesInASimulation_NamesFileLineAndKey) {
    const TemporaryFolder folder;
    folder.write("effects.yaml", two_effects);
    const auto run = testing::run_program({"simulate", "macro-pulses", "--effects-file", "effects.yaml",
                                           "--effect", "sticky_cable:k=0.1,hard=1", "--out", "out"},
                                          folder.path());
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr("fidservo: effects.yaml:14: effects[1].formula: -k * "));
    EXPECT_THAT(run.err, HasSubstr("with k = 0.1, hard = 1, wide = 5; allowed: numbers up to 100 V"));
}

/// docs/effects.md lists what the program knows.
TEST(EffectsFile, Documentation_HasEveryPortAndVariable) {
    const std::string text = text_of(std::filesystem::path(FIDSERVO_SOURCE_DIR) / "docs/effects.md");
    for (const plant::PortDescription& port : plant::ports()) {
        std::vector<std::string_view> variables;
        for (const std::size_t variable : port.variables)
            variables.push_back(plant::variables_of(port.site)[variable].name);
        const std::string row =
            fmt::format("| `{}` | {} | {} | {} | {} |", port.name, port.unit.empty() ? "1" : port.unit,
                        fmt::join(port.blocks, ", "), fmt::join(variables, ", "), port.meaning);
        EXPECT_NE(text.find(row), std::string::npos) << row;
    }
    for (const plant::Site site :
         {plant::Site::carriage, plant::Site::encoder, plant::Site::micro, plant::Site::camera})
        for (const plant::Variable& variable : plant::variables_of(site)) {
            const std::string row =
                fmt::format("| `{}` | {} | {} |", variable.name, variable.unit.empty() ? "1" : variable.unit,
                            variable.meaning);
            EXPECT_NE(text.find(row), std::string::npos) << row;
        }
}

}  // namespace
}  // namespace fidservo
