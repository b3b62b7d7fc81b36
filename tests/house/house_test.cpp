// SPDX-License-Identifier: GPL-3.0-or-later
// The house is as CONTRIBUTING.md says. Each rule is first shown a file that breaks it.
#include "tests/house/house_rules.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::house {
namespace {

using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

const std::vector<SourceFile>& house() {
    static const std::vector<SourceFile> files = read_house(FIDSERVO_SOURCE_DIR);
    return files;
}

/// Findings of a rule in the whole house.
template <class Rule>
Findings in_the_house(const Rule& rule) {
    Findings all;
    for (const auto& file : house()) {
        const Findings findings = rule(file);
        all.insert(all.end(), findings.begin(), findings.end());
    }
    return all;
}

TEST(House, Read_HasFilesOfEveryRoomThatShips) {
    for (const char* room : {"core/", "vision/", "control/", "plant/", "src/", "tests/"}) {
        EXPECT_TRUE(std::any_of(house().begin(), house().end(), [&](const SourceFile& file) {
            return file.path.starts_with(room);
        })) << room;
    }
}

TEST(House, Arrows_RunOneWay) {
    EXPECT_THAT(forbidden_arrows({"vision/a.cpp", "#include \"plant/b.h\"\n"}), SizeIs(1));
    EXPECT_THAT(forbidden_arrows({"plant/a.cpp", "#include <a>\n#include \"reference/b.h\"\n"}), SizeIs(1));
    EXPECT_THAT(forbidden_arrows({"calib/a.cpp", "#include \"vision/b.h\"\n"}), IsEmpty());
    EXPECT_THAT(in_the_house(forbidden_arrows), IsEmpty());
}

TEST(House, RoomsOfTheDiagnosis_SeeThoseBeforeThem) {
    EXPECT_THAT(steps_up_in_gap({"gap/fit/a.cpp", "#include \"gap/search/b.h\"\n"}), SizeIs(1));
    EXPECT_THAT(steps_up_in_gap({"gap/search/a.cpp", "#include \"gap/fit/b.h\"\n"}), IsEmpty());
    EXPECT_THAT(steps_up_in_gap({"gap/fit/a.cpp", "#include \"gap/evidence.h\"\n"}), IsEmpty());
    EXPECT_THAT(steps_up_in_gap({"gap/attic/a.cpp", ""}), SizeIs(1));
    EXPECT_THAT(in_the_house(steps_up_in_gap), IsEmpty());
}

TEST(House, FoldersOfTheProgram_SeeEachOtherOneWay) {
    EXPECT_THAT(circles_in_src({{"src/session/a.h", "#include \"src/cli/b.h\"\n"}}), SizeIs(1));
    EXPECT_THAT(circles_in_src({{"src/files/rig/a.h", "#include \"src/files/text/b.h\"\n"},
                                {"src/files/text/b.h", "#include \"src/files/rig/a.h\"\n"},
                                {"src/cli/c.cpp", "#include \"src/files/rig/a.h\"\n"}}),
                SizeIs(2));
    EXPECT_THAT(circles_in_src(house()), IsEmpty());
}

TEST(House, Includes_AreWrittenFromTheTop) {
    const std::vector<SourceFile> two{{"vision/a.h", ""}, {"vision/b.cpp", "#include \"a.h\"\n"}};
    EXPECT_THAT(includes_not_from_the_top(two[1], two), SizeIs(1));
    EXPECT_THAT(in_the_house([](const auto& file) { return includes_not_from_the_top(file, house()); }),
                IsEmpty());
}

TEST(House, ThirdPartyTypes_StayInside) {
    const std::vector<SourceFile> two{{"vision/a.h", "#pragma once\n#include <visp3/core/vpMatrix.h>\n"},
                                      {"src/b.cpp", "#include \"vision/a.h\"\n"}};
    EXPECT_THAT(leaking_third_party(two[0], two), SizeIs(1));
    EXPECT_THAT(in_the_house([](const auto& file) { return leaking_third_party(file, house()); }), IsEmpty());
}

TEST(House, Namespaces_AreTheRooms) {
    EXPECT_THAT(wrong_namespace({"plant/a.h", "namespace fidservo {"}), SizeIs(1));
    EXPECT_THAT(in_the_house(wrong_namespace), IsEmpty());
}

TEST(House, Headers_AreGuarded) {
    EXPECT_THAT(unguarded_header({"core/a.h", "namespace fidservo {}"}), SizeIs(1));
    EXPECT_THAT(in_the_house(unguarded_header), IsEmpty());
}

TEST(House, Sources_StateTheirLicence) {
    EXPECT_THAT(unlicensed({"core/a.h", "#pragma once\n"}), SizeIs(1));
    EXPECT_THAT(in_the_house(unlicensed), IsEmpty());
}

TEST(House, Files_AreReadInOneSitting) {
    EXPECT_THAT(too_long({"core/a.cpp", std::string(401, '\n')}), SizeIs(1));
    EXPECT_THAT(in_the_house(too_long), IsEmpty());
}

TEST(House, Files_NameNoMachine) {
    const std::string path = std::string("/ho") + "me/me/data";
    EXPECT_THAT(machine_paths({"core/a.cpp", "open(\"" + path + "\")"}), SizeIs(1));
    EXPECT_THAT(in_the_house(machine_paths), IsEmpty());
}

TEST(House, Rooms_DoNotLookAtTheWallClock) {
    EXPECT_THAT(wall_clocks({"src/a.cpp", "std::chrono::system_clock::now()"}), SizeIs(1));
    EXPECT_THAT(wall_clocks({"control/a.cpp", "std::time(nullptr)"}), SizeIs(1));
    EXPECT_THAT(in_the_house(wall_clocks), IsEmpty());
}

TEST(House, Documents_NameTestsThatAreThere) {
    const std::vector<SourceFile> one{{"tests/a_test.cpp", "TEST_F(Suite, Thing_Happens) {}"}};
    EXPECT_THAT(tests_that_are_not_there({"a.md", "`Suite.Thing_Happens`"}, one), IsEmpty());
    EXPECT_THAT(tests_that_are_not_there({"a.md", "`Suite.Thing_IsGone`"}, one), SizeIs(1));
    for (const SourceFile& document : read_documents(FIDSERVO_SOURCE_DIR))
        EXPECT_THAT(tests_that_are_not_there(document, house()), IsEmpty());
}

TEST(House, ADiagnosis_AsksForNoEffectByItsNameBlockOrUnit) {
    const std::vector<SourceFile> one{{"plant/effects/a.cpp", "    .name = \"hall_gain\",\n"}};
    EXPECT_THAT(effects_asked_for({"gap/a.cpp", "if (effect.name == \"hall_gain\")"}, one), SizeIs(1));
    EXPECT_THAT(effects_asked_for({"gap/a.cpp", "block.starts_with(\"macro.\")"}, one), SizeIs(1));
    EXPECT_THAT(effects_asked_for({"gap/a.cpp", "if (parameter.unit == \"mm\")"}, one), SizeIs(1));
    EXPECT_THAT(effects_asked_for({"src/a.cpp", "if (effect.name == \"hall_gain\")"}, one), IsEmpty());
    EXPECT_THAT(in_the_house([](const auto& file) { return effects_asked_for(file, house()); }), IsEmpty());
}

TEST(House, Examples_AreShorterThan60Lines) {
    std::size_t examples = 0;
    for (const auto& entry : std::filesystem::directory_iterator(FIDSERVO_SOURCE_DIR "/examples")) {
        if (entry.path().extension() != ".cpp") continue;
        std::ifstream file(entry.path());
        EXPECT_LT(std::count(std::istreambuf_iterator<char>(file), {}, '\n'), 60) << entry.path();
        ++examples;
    }
    EXPECT_EQ(examples, 8);
}

TEST(House, Files_HoldNoNotesToSelf) {
    EXPECT_THAT(notes_to_self({"core/a.cpp", std::string("// TO") + "DO: later"}), Not(IsEmpty()));
    EXPECT_THAT(in_the_house(notes_to_self), IsEmpty());
}

}  // namespace
}  // namespace fidservo::house
