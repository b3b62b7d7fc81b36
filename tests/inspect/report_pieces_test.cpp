// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/report/chart.h"
#include "src/report/html.h"
#include "src/report/page.h"
#include "src/report/plot.h"

#include <cmath>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo::report {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string encoded(const std::string& text) {
    return base64({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

TEST(Base64, TestVectorsOfRfc4648) {
    EXPECT_EQ(encoded(""), "");
    EXPECT_EQ(encoded("f"), "Zg==");
    EXPECT_EQ(encoded("fo"), "Zm8=");
    EXPECT_EQ(encoded("foo"), "Zm9v");
    EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(Html, Escaped_NothingGetsThrough) {
    EXPECT_EQ(escaped("<a href=\"x\">'&"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;");
}

TEST(Html, Number_TrueMinusAndNoNegativeZero) {
    EXPECT_EQ(number(-1.25, 1), "\u22121.2");
    EXPECT_EQ(number(-0.001, 1), "0.0");
    EXPECT_EQ(number(std::nan(""), 1), "\u2013");
}

TEST(Page, Rendered_LoadsNothingFromOutside) {
    Page page;
    page.title = page.headline = "A <run>";
    const std::string html = render(page);
    EXPECT_THAT(html, HasSubstr("<h1>A &lt;run&gt;</h1>"));
    EXPECT_THAT(html, HasSubstr("default-src 'none'"));
    for (const char* link : {"src=\"http", "href=\"http", "url(http", "@import", "<link"})
        EXPECT_THAT(html, Not(HasSubstr(link)));
    EXPECT_THAT(html, HasSubstr("uPlot"));
}

TEST(Envelope, Spike_IsKept) {
    std::vector<float> values(10000, 0.0f);
    values[4321] = 5.0f;
    values[7777] = -3.0f;
    const auto rows = envelope_rows(values, 200);
    EXPECT_LE(rows.size(), 200u);
    EXPECT_TRUE(std::ranges::is_sorted(rows));
    EXPECT_THAT(rows, testing::Contains(4321u));
    EXPECT_THAT(rows, testing::Contains(7777u));
}

TEST(Envelope, FewRows_AllAreKept) {
    const auto rows = envelope_rows(std::vector<float>(7, 1.0f), 200);
    ASSERT_EQ(rows.size(), 7u);
    EXPECT_EQ(rows[6], 6u);
}

TEST(TimePlots, LabelWithMarkup_CannotEndTheScript) {
    const std::string html = time_plots({{0.0, 1.0}, {{0.0, 1.0, "</script>", "good"}}},
                                        {{"p", "Title", "mm", "g", 200, {{"a", {1.0f, 2.0f}}}}});
    EXPECT_THAT(html, Not(HasSubstr("</script>\",")));
}

TEST(Histogram, CountsBecomeBars) {
    const std::string svg =
        histogram_svg({"error", -1.0, 0.5, {"pass", "fail"}, {{0, 3, 1, 0}, {1, 0, 0, 0}}, {0.0}});
    EXPECT_THAT(svg, HasSubstr("<title>pass: 3</title>"));
    EXPECT_THAT(svg, HasSubstr("<title>fail: 1</title>"));
}

}  // namespace
}  // namespace fidservo::report
