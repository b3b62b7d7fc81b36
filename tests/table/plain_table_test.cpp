// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/table/plain_table.h"

#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TemporaryFolder;

using Rows = std::vector<std::vector<double>>;

Rows rows_of(const std::string& bytes, const TableOptions& options = {}) {
    const PlainTable table = PlainTable::parse(TextFile::parse(bytes, "table.txt"), options);
    Rows rows;
    table.for_each_row([&](const TableRow& row) {
        rows.emplace_back();
        for (std::size_t k = 0; k < table.columns(); ++k)
            if (table.kind(k) == FieldKind::number) rows.back().push_back(table.number(row, k));
    });
    return rows;
}

std::string refusal_of(const std::string& bytes, const TableOptions& options = {}) {
    return message_of([&] { rows_of(bytes, options); });
}

TEST(PlainTable, Encodings_AreRead) {
    const std::string text = "t;x\r\n1;2\r\n";
    const auto utf16 = [&](bool low_first) {
        std::string bytes = low_first ? "\xFF\xFE" : "\xFE\xFF";
        for (const char letter : text)
            bytes.append(low_first ? std::string{letter, '\0'} : std::string{'\0', letter});
        return bytes;
    };
    for (const std::string& bytes : {text, "\xEF\xBB\xBF" + text, utf16(true), utf16(false), text + "\x1A"})
        EXPECT_EQ(rows_of(bytes), (Rows{{1, 2}}));
    EXPECT_THAT(refusal_of(utf16(true) + "x"), HasSubstr("begins as UTF-16 does, and breaks off"));
    EXPECT_THAT(refusal_of(utf16(true).substr(2)), HasSubstr("byte 2 is 0x00: no text"));
}

TEST(PlainTable, LineEnds_AreAllRead) {
    for (const char* text :
         {"1;2\n3;4\n", "1;2\r\n3;4\r\n", "1;2\r3;4\r", "1;2\r\r\n3;4\r\r\n", "\n1;2\n\n3;4", "1;2\r\n3;4\n"})
        EXPECT_EQ(rows_of(text), (Rows{{1, 2}, {3, 4}})) << text;
}

TEST(PlainTable, Comments_ArePassedOverWhereverTheyStand) {
    for (const char* text :
         {"# a\n1,2\n% b\n3,4\n", "// a, b\n1,2\n# 5,6\n3,4\n#end\n", "; a\n1,2\n3,4\n! c\n"})
        EXPECT_EQ(rows_of(text), (Rows{{1, 2}, {3, 4}})) << text;
    EXPECT_EQ(rows_of(";1;2\n;3;4\n"), (Rows{{1, 2}, {3, 4}}));  // an empty first column
}

TEST(PlainTable, QuotesAndTrailingSeparators_AreNoFieldsOfTheirOwn) {
    EXPECT_EQ(rows_of("\"1,5\",\"2\"\n\"3\",\"4,25\"\n"), (Rows{{1.5, 2}, {3, 4.25}}));
    EXPECT_EQ(rows_of("t;x;\n1;2;\n3;4;\n"), (Rows{{1, 2}, {3, 4}}));
    EXPECT_EQ(rows_of("'1' 2\n3 4\n"), (Rows{{1, 2}, {3, 4}}));
}

TEST(PlainTable, DecimalSign_IsThatOfAnyNumberThatTells) {
    EXPECT_EQ(rows_of("1,234;0,5\n2,345;1\n"), (Rows{{1.234, 0.5}, {2.345, 1}}));
    EXPECT_EQ(rows_of("1,234;0.5\n2,345;1\n"), (Rows{{1234, 0.5}, {2345, 1}}));
    EXPECT_EQ(rows_of("1.234;1.234,5\n"), (Rows{{1234, 1234.5}}));
    EXPECT_EQ(rows_of("1,234\t1,234,567\n"), (Rows{{1234, 1234567}}));
    // A comma that separates columns is no decimal sign, so the point is one, not a thousands separator.
    EXPECT_EQ(rows_of("1.234,2\n"), (Rows{{1.234, 2}}));
}

TEST(PlainTable, NumberThatCouldMeanTwoThings_IsAskedFor) {
    EXPECT_THAT(
        refusal_of("t;x\n1;1,234\n2;2,345\n"),
        HasSubstr("table.txt:2: column 2: '1,234': could be 1234 or 1.234, and no number of the table tells: "
                  "say --decimal point or --decimal comma"));
    EXPECT_THAT(refusal_of("t;x\n1;1.234\n"), HasSubstr("'1.234': could be 1.234 or 1234"));
    EXPECT_EQ(rows_of("1;1,234\n", {.decimal = DecimalSign::comma}), (Rows{{1, 1.234}}));
    EXPECT_EQ(rows_of("1;1,234\n", {.decimal = DecimalSign::point}), (Rows{{1, 1234}}));
    EXPECT_THAT(refusal_of("1;1,5\n2;1.5\n"),
                HasSubstr("'1,5' has a decimal comma, but '1.5' in line 2 a decimal point"));
    EXPECT_THAT(refusal_of("1;1.5\n", {.decimal = DecimalSign::comma}),
                HasSubstr("'1.5' is no number with a decimal comma"));
}

TEST(PlainTable, CommasBetweenFieldsAndInNumbers_AreRefused) {
    EXPECT_THAT(refusal_of("t,x\n0,5,1,25\n0,6,1,35\n"), HasSubstr("there are 4 fields, but 2 above them"));
    EXPECT_THAT(refusal_of("0,05,1,5\n0,10,1,6\n"), HasSubstr("column 2 could be the decimals of column 1"));
    EXPECT_THAT(refusal_of("1,172.5,3\n2,256.0,4\n"),
                HasSubstr("column 2 could be the last digits of column 1"));
    EXPECT_THAT(refusal_of("0,05,1,5\n0,10,1,6\n", {.decimal = DecimalSign::comma}),
                HasSubstr("a table with commas both between its fields and in its numbers cannot be read"));
    EXPECT_EQ(rows_of("0,05,1\n0,10,1\n", {.decimal = DecimalSign::point}), (Rows{{0, 5, 1}, {0, 10, 1}}));
    EXPECT_EQ(rows_of("a,b,c\n0,1005,1\n0,1010,1\n"), (Rows{{0, 1005, 1}, {0, 1010, 1}}));
}

TEST(PlainTable, LabViewsFile_IsRead) {
    const std::string text =
        "LabVIEW "
        "Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\n***End_of_Header***"
        "\t\t\t\n\t\t\t\n"
        "Channels\t1\t\t\nSamples\t2\t\t\nX0\t0,0000E+0\t\t\n***End_of_Header***\t\t\t\n"
        "X_Value\tVoltage\tComment\n0,000\t1,234\n1,000\t2,345\n";
    EXPECT_EQ(rows_of(text), (Rows{{0, 1.234}, {1, 2.345}}));
    const PlainTable table = PlainTable::parse(TextFile::parse(text, "a.lvm"));
    ASSERT_FALSE(table.titles().empty());
    EXPECT_THAT(table.titles().front().fields, ElementsAre("X_Value", "Voltage", "Comment"));
}

TEST(PlainTable, OscilloscopesWithTheirHeaderBesideTheRows_AreAskedAbout) {
    std::string text = "Record Length,2.5e3,,-0.0005,0.04,\nVertical Units,V,,-0.0004,0.02,\n";
    for (int k = 0; k < 50; ++k) text += fmt::format(",,,{:.4f},0.0{},\n", -0.0003 + 0.0001 * k, k % 10);
    EXPECT_THAT(refusal_of(text), HasSubstr("table.txt:"));
    EXPECT_THAT(refusal_of("x-axis,1\nsecond,Volt\n-1.5,\n,2\n"), HasSubstr("''"));
    EXPECT_EQ(rows_of("x-axis,1\nsecond,Volt\n-1.5,2\n"), (Rows{{-1.5, 2}}));
    const PlainTable start_beside_titles = PlainTable::parse(TextFile::parse(
        "X,CH1,Start,Increment,\nSequence,Volt,-6e-3,1e-5,\n0,1.5,,,\n1,2.5,,,\n2,3.5,,,\n", "a.csv"));
    EXPECT_EQ(start_beside_titles.first_line(), 3);
    start_beside_titles.for_each_row([&](const TableRow& row) {
        EXPECT_EQ(start_beside_titles.number(row, 1), 1.5 + start_beside_titles.number(row, 0));
    });
}

TEST(PlainTable, LinesBelow_ArePassedOverAndSaid) {
    const PlainTable table =
        PlainTable::parse(TextFile::parse("t,x\n1,2\n3,4\n,\nEnd of data\nMean: 3\n", "a.csv"));
    EXPECT_EQ(table.last_line(), 3);
    EXPECT_THAT(table.notes(), ElementsAre("3 lines below the rows are passed over, from line 4 on: ','"));
}

TEST(PlainTable, HeaderLines_AreWhatTheUserSays) {
    EXPECT_EQ(rows_of("1,1\n2,2\nt,x\n3,4\n", {.header_lines = 3}), (Rows{{3, 4}}));
    EXPECT_THAT(refusal_of("1,1\n2,2\nt,x\n3,4\n", {.header_lines = 1}), HasSubstr("table.txt:"));
    EXPECT_THAT(refusal_of("1,1\n2,2\n", {.header_lines = 2}),
                HasSubstr("--header-lines: 2: there is no line below"));
    EXPECT_THAT(refusal_of("1,1\n2,2\n", {.header_lines = 9}),
                HasSubstr("--header-lines: 9: the file has 2 lines"));
}

TEST(PlainTable, StatedSeparator_IsTaken) {
    EXPECT_EQ(rows_of("sep=;\nt;x\n1,5;2\n"), (Rows{{1.5, 2}}));
    EXPECT_EQ(rows_of("1 2,5\n3 4,5\n", {.separator = ' '}), (Rows{{1, 2.5}, {3, 4.5}}));
}

TEST(PlainTable, WhatIsTooLarge_IsRefusedWithTheLimit) {
    const std::string number = "1,";
    std::string wide;
    for (int k = 0; k < 20'000; ++k) wide += number;
    EXPECT_THAT(refusal_of(wide + "1\n"), HasSubstr("more than 10000 fields, the most that are read"));
    EXPECT_THAT(refusal_of("1,2\n" + std::string((1U << 20U) + 1, '7') + "\n"),
                HasSubstr("allowed: 1048576 at most"));
    const TemporaryFolder folder;
    const auto huge = folder.write("huge.csv", "1,2\n");
    std::filesystem::resize_file(huge, std::uintmax_t{5} << 30U);
    EXPECT_THAT(message_of([&] { PlainTable::load(huge); }), HasSubstr("has more than 1073741824 bytes"));
}

TEST(PlainTable, BinaryFile_IsNoText) {
    EXPECT_THAT(refusal_of(std::string("\x89PNG\r\n\x1A\n\0\0\0\rIHDR", 16)),
                HasSubstr("byte 8 is 0x1a: no text"));
    EXPECT_THAT(refusal_of(std::string("1,2\n3,\0\n", 8)), HasSubstr("byte 7 is 0x00: no text"));
    EXPECT_THAT(message_of([] { PlainTable::load("/dev/zero"); }),
                HasSubstr("cannot be opened as a text file"));
}

}  // namespace
}  // namespace fidservo
