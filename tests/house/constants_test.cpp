// SPDX-License-Identifier: GPL-3.0-or-later
// Each number of the diagnosis is in docs/constants.md. Each rule is first shown what breaks it.
#include "tests/house/constants.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::house {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

SourceFile of_gap(const std::string& text) {
    return {"gap/fit/a.cpp", text};
}

/// The list with these lines below the heading of gap/fit.
SourceFile list_of(const std::string& lines) {
    return {"docs/constants.md",
            "## gap/fit\n\n| file | name | value | kind | why |\n|---|---|---|---|---|\n" + lines};
}

Findings off_the_list(const std::string& code, const std::string& lines) {
    return constants_off_the_list({of_gap(code)}, list_of(lines));
}

const std::string one = "constexpr double least = 0.05;\n",
                  its_line = "| `a.cpp` | `least` | `0.05` | chosen | So. |\n";

TEST(Constants, ANumberInTheCode_HasAName) {
    EXPECT_THAT(nameless_numbers(of_gap("double a = 3.0 * b;\n")),
                ElementsAre("gap/fit/a.cpp:1: a number without a name: 3.0"));
    EXPECT_THAT(nameless_numbers(of_gap("f(\n  a, 1e-9);\n")), ElementsAre(HasSubstr("a.cpp:2:")));
    EXPECT_THAT(nameless_numbers(of_gap("for (const double x : {0.2, 0.5}) f(x);\n")), SizeIs(1));
    EXPECT_THAT(nameless_numbers(of_gap("double f(double share = 0.98);\n")), SizeIs(1));
    EXPECT_THAT(nameless_numbers(of_gap("void f() { double low = 0.25; }\n")), SizeIs(1));
    EXPECT_THAT(nameless_numbers(of_gap("constexpr auto f = g([](double x) { return 1.01 * x; });\n")),
                SizeIs(1));
    EXPECT_THAT(nameless_numbers({"plant/a.cpp", "double a = 3.0;\n"}), IsEmpty());
}

TEST(Constants, ANumber_MayBeOneOfFour) {
    EXPECT_THAT(nameless_numbers(of_gap("a = 0 + 1U - 2.0 * b + 0.5 * x3 + 1'0;\n")), SizeIs(1));
    EXPECT_THAT(nameless_numbers(of_gap("a = 0 + 1U - 2.0 * b + 0.5 * x3;\n")), IsEmpty());
}

TEST(Constants, ANumber_MayBeOfATextACommentOrAnInclude) {
    EXPECT_THAT(
        nameless_numbers(of_gap("#include \"v4.h\"\n// 3 of them\nf(\"7 \\\" 8\", '9', \"{:.3f}\");\n")),
        IsEmpty());
}

TEST(Constants, ANumber_MayBeOfATypesRowsOrColumns) {
    EXPECT_THAT(
        nameless_numbers(of_gap("std::array<std::vector<int>, 3> a;\nEigen::Matrix<double, 4, 4> b;\n")),
        IsEmpty());
    EXPECT_THAT(nameless_numbers(of_gap("std::array<int, n> a(4);\n")), SizeIs(1));
}

TEST(Constants, ANumber_MayBeMathematicsOfTheNextStatementOrFunction) {
    EXPECT_THAT(nameless_numbers(of_gap("// Mathematics: a rule.\na = (b + 4.0 * c) / 6.0;\n")), IsEmpty());
    EXPECT_THAT(nameless_numbers(of_gap("// Mathematics: a rule.\na = b / 6.0;\nd = 6.0;\n")), SizeIs(1));
    EXPECT_THAT(nameless_numbers(of_gap("/// Mathematics: a law.\ndouble f(double x) {\n    x *= 3.0;\n    "
                                        "return 4.0 * x;\n}\nint b = 3;\n")),
                SizeIs(1));
    EXPECT_THAT(nameless_numbers(of_gap("// Some mathematics.\na = b / 6.0;\n")), SizeIs(1));
}

TEST(Constants, AConstant_IsWhatHasANameAndANumber) {
    EXPECT_THAT(
        constants_of(of_gap(
            "inline constexpr double a = 0.5, b = 1e-3;\nconstexpr std::array<int, 2> c{3,\n    4};\n")),
        ElementsAre(Constant{"gap/fit/a.cpp", "a", "0.5"}, Constant{"gap/fit/a.cpp", "b", "1e-3"},
                    Constant{"gap/fit/a.cpp", "c", "{3, 4}"}));
    EXPECT_THAT(
        constants_of(of_gap(
            "struct Options {\n    int a = 0, most = 12;\n    double f() const { return 1.0; }\n};\n")),
        ElementsAre(Constant{"gap/fit/a.cpp", "Options::most", "12"}));
    EXPECT_THAT(constants_of(of_gap("constexpr int f(int a) { return a; }\nif constexpr (a) b = 1;\n")),
                IsEmpty());
}

TEST(Constants, WhatFollowsFromConstants_IsNone) {
    EXPECT_THAT(constants_of(of_gap(
                    "constexpr double a = 2.0 * b, nan = std::numeric_limits<double>::quiet_NaN();\n")),
                IsEmpty());
    EXPECT_THAT(constants_of(of_gap("constexpr double a = 4.0 * b;\n")), SizeIs(1));
    EXPECT_THAT(constants_of(of_gap("constexpr Effort a{.fits = 1};\n")), SizeIs(1));
}

TEST(Constants, AConstant_IsListedWithItsValueKindAndReason) {
    EXPECT_THAT(off_the_list(one, its_line), IsEmpty());
    EXPECT_THAT(off_the_list(one, ""), ElementsAre(HasSubstr("is not in docs/constants.md")));
    EXPECT_THAT(off_the_list(one, "| `a.cpp` | `least` | `0.06` | chosen | So. |\n"), SizeIs(2));
    EXPECT_THAT(off_the_list(one, "| `b.cpp` | `least` | `0.05` | chosen | So. |\n"), SizeIs(2));
    EXPECT_THAT(off_the_list(one, "| `a.cpp` | `least` | `0.05` | tuned | So. |\n"), SizeIs(1));
    EXPECT_THAT(off_the_list(one, "| `a.cpp` | `least` | `0.05` | chosen | |\n"), SizeIs(1));
    EXPECT_THAT(off_the_list(one, its_line + its_line), ElementsAre(HasSubstr("twice")));
}

TEST(Constants, ALineOfTheList_IsOfAConstant) {
    EXPECT_THAT(off_the_list("", its_line), ElementsAre(HasSubstr("not in the code")));
    EXPECT_THAT(off_the_list("const double least = 0.05;\n", its_line),
                ElementsAre(HasSubstr("not in the code")));
}

TEST(Constants, TheList_SaysHowManyThereAreOfAKind) {
    EXPECT_THAT(miscounted_kinds(list_of("| chosen | by judgement | 1 |\n" + its_line)), IsEmpty());
    EXPECT_THAT(miscounted_kinds(list_of("| chosen | by judgement | 2 |\n" + its_line)), SizeIs(1));
    EXPECT_THAT(miscounted_kinds(list_of(its_line)), SizeIs(1));
}

TEST(Constants, OfTheDiagnosis_AreNamedAndListed) {
    const std::vector<SourceFile> house = read_house(FIDSERVO_SOURCE_DIR);
    Findings nameless;
    for (const SourceFile& file : house)
        for (std::string& finding : nameless_numbers(file)) nameless.push_back(std::move(finding));
    EXPECT_THAT(nameless, IsEmpty());
    const std::vector<SourceFile> documents = read_documents(FIDSERVO_SOURCE_DIR);
    const auto list = std::ranges::find_if(
        documents, [](const SourceFile& document) { return document.path == "docs/constants.md"; });
    ASSERT_NE(list, documents.end());
    EXPECT_THAT(constants_off_the_list(house, *list), IsEmpty());
    EXPECT_THAT(miscounted_kinds(*list), IsEmpty());
}

}  // namespace
}  // namespace fidservo::house
