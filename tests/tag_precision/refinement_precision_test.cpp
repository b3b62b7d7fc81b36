// refine_tag against the Cramer-Rao bound of every kind of picture.
#include "tests/effort.h"
#include "tests/tag_precision/precision_trials.h"

#include <cctype>
#include <iostream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::precision {

void PrintTo(const PrecisionCase& of, std::ostream* out) {
    *out << of.name;
}

namespace {

class RefinementPrecision : public ::testing::TestWithParam<PrecisionCase> {};

/// 200 frames: what is found wrong is wrong for certain.
TEST_P(RefinementPrecision, FewFrames_DoNotContradictTheLimits) {
    const PrecisionFigures figures =
        judge(GetParam(), {.shifts = 10, .draws = fidservo::testing::cases(20, 3), .seed = 1},
              refinement(GetParam()));
    const auto found = reproaches(figures, GetParam().limits, true);
    EXPECT_THAT(found, ::testing::IsEmpty()) << table_heading() << "\n" << table_row(figures);
}

class SlowRefinementPrecision : public ::testing::TestWithParam<PrecisionCase> {};

/// 5,000 frames: limits are kept with 95 % certainty.
TEST_P(SlowRefinementPrecision, ManyFrames_KeepTheLimits) {
    const PrecisionFigures figures = judge(GetParam(), {.seed = 2}, refinement(GetParam()));
    std::cout << table_heading() << "\n" << table_row(figures) << "\n";
    for (const std::string& reproach : reproaches(figures, GetParam().limits, false))
        ADD_FAILURE() << reproach;
}

std::string test_name(const ::testing::TestParamInfo<PrecisionCase>& info) {
    std::string name;
    for (const char c : info.param.name) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(Case, RefinementPrecision, ::testing::ValuesIn(precision_cases()), test_name);
INSTANTIATE_TEST_SUITE_P(SlowCase, SlowRefinementPrecision, ::testing::ValuesIn(precision_cases()),
                         test_name);

}  // namespace
}  // namespace fidservo::precision
