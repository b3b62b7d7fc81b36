// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/text/yaml_reader.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "tests/src/message_of.h"

#include <string>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using testing::message_of;

YamlValue parse(const std::string& text) {
    return YamlValue::parse(text, "rig.yaml");
}

TEST(YamlReader, Number_IsReadWithItsLine) {
    const YamlValue root = parse("a_mm: 1.5\nb: { c_V: +2e-3 }\n");
    EXPECT_DOUBLE_EQ(root.at("a_mm").number(), 1.5);
    EXPECT_DOUBLE_EQ(root.at("b").at("c_V").number(), 2e-3);
}

TEST(YamlReader, Number_WithAUnit_SaysThatTheUnitStandsInTheKey) {
    EXPECT_EQ(message_of([] { parse("x: 1\nblur_px: 0.8 px\n").at("blur_px").number(not_negative); }),
              "rig.yaml:2: blur_px: 0.8 px: must be a number in px of at least 0; the unit stands in the key "
              "alone");
}

TEST(YamlReader, Number_OutOfRange_NamesKeyValueAndRange) {
    EXPECT_EQ(message_of([] {
                  parse("macro:\n  low_V: -1\n").at("macro").at("low_V").number({0.0, 5.0, true});
              }),
              "rig.yaml:2: macro.low_V: -1: must be a number in V above 0 and at most 5");
}

TEST(YamlReader, Number_NotFiniteQuotedOrEmpty_IsRefused) {
    for (const char* value : {".nan", ".inf", "1e999", "\"5\"", "", "[1]", "0x10"})
        EXPECT_THROW(parse(std::string("a: ") + value).at("a").number(), InputError) << value;
}

TEST(YamlReader, UnknownKey_NamesTheKeyThatWasMeant) {
    const auto allow = [](const char* text) {
        return message_of([&] { parse(text).at("camera").allow_only({"blur_px", "focal_px", "width_px"}); });
    };
    EXPECT_EQ(allow("camera:\n  focl_px: 5000\n"),
              "rig.yaml:2: camera.focl_px: 5000: unknown key; did you mean focal_px?");
    EXPECT_EQ(allow("camera:\n  blur_mm: 0.8\n"),
              "rig.yaml:2: camera.blur_mm: 0.8: unknown key; did you mean blur_px, in px?");
    EXPECT_EQ(allow("camera: { colour: red }\n"),
              "rig.yaml:1: camera.colour: red: unknown key; allowed here: blur_px, focal_px, width_px");
}

TEST(YamlReader, MissingKey_NamesItAndItsUnit) {
    EXPECT_EQ(message_of([] { parse("hall:\n  cubic: 0.1\n").at("hall").at("gain_mm_per_s_per_V"); }),
              "rig.yaml:1: hall.gain_mm_per_s_per_V: missing: this key must be given, in mm/s/V");
}

TEST(YamlReader, KeyGivenTwice_IsRefused) {
    EXPECT_EQ(message_of([] { parse("a: 1\nb: { c: 1, c: 2 }\n"); }),
              "rig.yaml:2: c: the key is given twice");
}

TEST(YamlReader, ListOfTheWrongLength_SaysHowMany) {
    EXPECT_EQ(message_of([] { parse("travel_mm: [0, 1, 2]\n").at("travel_mm").numbers(2); }),
              "rig.yaml:1: travel_mm: a list: must be a list of 2 numbers in mm");
    EXPECT_EQ(message_of([] { parse("travel_mm: [0, far]\n").at("travel_mm").numbers(2); }),
              "rig.yaml:1: travel_mm[1]: far: must be a number in mm; the unit stands in the key alone");
}

TEST(YamlReader, Word_NotInTheList_ShowsTheList) {
    EXPECT_EQ(message_of([] {
                  parse("check: dott\n").at("check").one_of({"dot", "line"});
              }),
              "rig.yaml:1: check: dott: must be one of: dot, line");
}

TEST(YamlReader, File_IsRelativeToTheFilesFolder) {
    const YamlValue root = YamlValue::parse("fod: ../tables/a.csv\nall: /data/b.csv\n", "rigs/rig.yaml");
    EXPECT_EQ(root.at("fod").file(), "tables/a.csv");
    EXPECT_EQ(root.at("all").file(), "/data/b.csv");
}

TEST(YamlReader, NotYaml_IsAnInputErrorWithTheLine) {
    EXPECT_TRUE(message_of([] { parse("a: [1, 2\nb: 3\n"); }).starts_with("rig.yaml:2: not YAML: "));
    for (const char* text : {"", "- 1\n", "word", "? [a]\n: 1\n"})
        EXPECT_THROW(parse(text), InputError) << text;
}

TEST(YamlReader, MoreThanOneDocument_IsRefusedWhereTheSecondBegins) {
    EXPECT_EQ(message_of([] { parse("a: 1\n---\nb: 2\n"); }),
              "rig.yaml:2: the file must hold one map of keys and values; it ends before here");
    EXPECT_THROW(parse(", cols: 3, data: [1, 2]\ncamera_matrix: { rows: 3 }\n"), InputError);
    EXPECT_NO_THROW(parse("---\na: 1\n...\n"));
}

TEST(YamlReader, AliasesThatGrowOrNeverEnd_AreRefused) {
    std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n";
    for (int i = 1; i < 12; ++i) {
        const std::string last = "*a" + std::to_string(i - 1);
        bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + last;
        for (int k = 0; k < 8; ++k) bomb += ", " + last;
        bomb += "]\n";
    }
    EXPECT_THROW(parse(bomb), InputError);
    EXPECT_THROW(parse("a: &a [*a]\n"), InputError);
    EXPECT_THROW(parse("a: " + std::string(5000, '[') + std::string(5000, ']')), InputError);
}

TEST(YamlReader, BytesThatAreNoText_AreRefusedWithTheirLine) {
    EXPECT_EQ(message_of([] { parse("a: 1\nb: \xff\n"); }),
              "rig.yaml:2: holds bytes that are not text in UTF-8");
    for (const char* bytes : {"\x04", "\x1b", "\x80", "\xc0\x80", "\xc3", "\xe0\x80\x80", "\xed\xa0\x80",
                              "\xf5\x80\x80\x80", "\xf4\x90\x80\x80", "\xe2\x82"})
        EXPECT_THROW(parse(std::string("a: ") + bytes), InputError) << bytes;
    for (const char* text : {"\xc2\xb5", "\xe2\x82\xac", "\xf0\x9f\x93\xb7", "\xef\xbf\xbd", "\t"})
        EXPECT_NO_THROW(parse(std::string("a: 'x") + text + "'")) << text;
}

TEST(YamlReader, File_ThatIsNotThere_IsNamed) {
    EXPECT_EQ(message_of([] { YamlValue::load("no-such.yaml"); }), "no-such.yaml: cannot be opened");
    EXPECT_THROW(YamlValue::load(std::filesystem::temp_directory_path()), InputError);
}

TEST(YamlReader, KeysOfAnotherKindOfFile_AreNotTakenForSlips) {
    const auto message = [](const char* text) {
        return message_of([&] {
            YamlValue::parse(text, "f.yaml").allow_only({"tagCols", "tagRows", "tagSize"});
        });
    };
    EXPECT_EQ(message("targetCols: 6\ntargetRows: 7\nspacing: 1\n"),
              "f.yaml:1: targetCols: 6: unknown key; allowed here: tagCols, tagRows, tagSize");
    EXPECT_EQ(message("tagCol: 6\ntagRows: 7\ntagSize: 1\n"),
              "f.yaml:1: tagCol: 6: unknown key; did you mean tagCols?");
}

TEST(YamlReader, MarkAndOpenCvsFirstLine_ArePassedOver) {
    for (const char* text : {"\xEF\xBB\xBF"
                             "a: 1\n",
                             "%YAML:1.0\n---\na: 1\n", "%YAML:1.0\na: 1\n"})
        EXPECT_EQ(YamlValue::parse(text, "f.yaml").at("a").number(), 1.0) << text;
}

}  // namespace
}  // namespace fidservo
