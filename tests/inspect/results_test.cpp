// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/measure/results.h"

#include <gtest/gtest.h>

namespace fidservo::inspect {
namespace {

Visit visit_with(std::vector<ResultRow> rows) {
    Visit visit{};
    visit.site = 12;
    visit.end = Visit::End::measured;
    visit.rows = std::move(rows);
    return visit;
}

TEST(Results, Csv_HasTheColumnsAndOneRowACheck) {
    const Visit visit = visit_with({{12, "left", "mark_diameter", "dot@12", 300.1234, "um", 0.05, 300.0, 10.0,
                                     Outcome::pass, "", "images/site-012-left.png"}});
    EXPECT_EQ(
        results_csv({visit}),
        "site,view,check,feature,value,unit,uncertainty,nominal,tolerance,verdict,reason,image\n"
        "12,left,mark_diameter,dot@12,300.123,um,0.050,300.000,10.000,pass,,images/site-012-left.png\n");
}

TEST(Results, Csv_QuotesTextAndLeavesMissingNumbersEmpty) {
    const Visit visit =
        visit_with({{12, "left", "mark", "dot@12", std::nullopt, "um", std::nullopt, std::nullopt,
                     std::nullopt, Outcome::fail, "not \"there\", it seems", ""}});
    EXPECT_NE(results_csv({visit}).find("12,left,mark,dot@12,,um,,,,fail,\"not \"\"there\"\", it seems\",\n"),
              std::string::npos);
}

TEST(Results, OutcomeOfVisit_IsTheWorstRow) {
    ResultRow row{};
    row.verdict = Outcome::pass;
    Visit visit = visit_with({row});
    EXPECT_EQ(outcome_of(visit), Outcome::pass);
    row.verdict = Outcome::not_decidable;
    visit.rows.push_back(row);
    EXPECT_EQ(outcome_of(visit), Outcome::not_decidable);
    row.verdict = Outcome::fail;
    visit.rows.insert(visit.rows.begin(), row);
    EXPECT_EQ(outcome_of(visit), Outcome::fail);
    EXPECT_EQ(count({visit}).total(), 3);
}

}  // namespace
}  // namespace fidservo::inspect
