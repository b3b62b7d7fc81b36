// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/table/number_notation.h"

#include "src/files/table/clock_time.h"

#include <gtest/gtest.h>

namespace fidservo {
namespace {

constexpr double not_a_number = -987.0;

double by(DecimalSign sign, std::string_view field) {
    return number_of(field, sign).value_or(not_a_number);
}

TEST(NumberNotation, FieldsOfEitherSign_AreReadOrRefused) {
    struct Example {
        std::string_view field;
        double by_point, by_comma;
        SignEvidence evidence;
    };
    constexpr double none = not_a_number;
    for (const Example& e : {Example{"12", 12, 12, SignEvidence::none},
                             Example{"-3e5", -3e5, -3e5, SignEvidence::none},
                             Example{"1.5", 1.5, none, SignEvidence::point},
                             Example{"1,5", none, 1.5, SignEvidence::comma},
                             Example{"0.123", 0.123, none, SignEvidence::point},
                             Example{"0,123", none, 0.123, SignEvidence::comma},
                             Example{"1.234", 1.234, 1234, SignEvidence::point_or_group},
                             Example{"-1,234", -1234, -1.234, SignEvidence::point_or_group},
                             Example{"1234,567", none, 1234.567, SignEvidence::comma},
                             Example{"1,234.5", 1234.5, none, SignEvidence::point},
                             Example{"1.234,5", none, 1234.5, SignEvidence::comma},
                             Example{"1,234,567", 1234567, none, SignEvidence::point},
                             Example{"1.234.567", none, 1234567, SignEvidence::comma},
                             Example{"1.234.567,25", none, 1234567.25, SignEvidence::comma},
                             Example{"1'234.5", 1234.5, none, SignEvidence::point},
                             Example{"1\xC2\xA0"
                                     "234,567",
                                     none, 1234.567, SignEvidence::comma},
                             Example{"1.234e2", 123.4, none, SignEvidence::point},
                             Example{"1,234E+02", none, 123.4, SignEvidence::comma},
                             Example{"1.5D-03", 1.5e-3, none, SignEvidence::point},
                             Example{"+.5", 0.5, none, SignEvidence::point},
                             Example{"7.", 7, none, SignEvidence::point},
                             Example{"\xE2\x88\x92"
                                     "1,5",
                                     none, -1.5, SignEvidence::comma}}) {
        SCOPED_TRACE(e.field);
        EXPECT_EQ(look_at(e.field).kind, FieldKind::number);
        EXPECT_EQ(look_at(e.field).evidence, e.evidence);
        EXPECT_DOUBLE_EQ(by(DecimalSign::point, e.field), e.by_point);
        EXPECT_DOUBLE_EQ(by(DecimalSign::comma, e.field), e.by_comma);
    }
}

TEST(NumberNotation, OtherFields_AreTextNothingOrTimes) {
    for (const std::string_view text : {"x", "1,2,3", "1.2.3", "12,34,567", "1.5 V", "5,", ",5", "1e", "--5",
                                        "1-2", "0x10", "12:30", "1.234,567.8", "2020-03-16"}) {
        EXPECT_EQ(look_at(text).kind, FieldKind::text) << text;
        EXPECT_FALSE(number_of(text, DecimalSign::point)) << text;
        EXPECT_FALSE(number_of(text, DecimalSign::comma)) << text;
    }
    for (const std::string_view nothing : {"", "NaN", "n/a", "--", "1.#QNAN"})
        EXPECT_EQ(look_at(nothing).kind, FieldKind::empty) << nothing;
    for (const std::string_view time :
         {"17:04:51", "2020-03-16T17:04:51.5Z", "16.03.2020 17:04:51,25", "04:51.5"})
        EXPECT_EQ(look_at(time).kind, FieldKind::time) << time;
}

TEST(ClockTime, DatesAndTimes_AreNanoseconds) {
    constexpr std::int64_t s = 1'000'000'000, day = 86'400 * s;
    const auto ns = [](std::string_view text) {
        return clock_time_of(text).value_or(ClockTime{.ns = -1}).ns;
    };
    EXPECT_EQ(ns("17:04:51"), (17 * 3600 + 4 * 60 + 51) * s);
    EXPECT_EQ(ns("5:04:51.250 PM"), (17 * 3600 + 4 * 60 + 51) * s + s / 4);
    EXPECT_EQ(ns("12:00:01 AM"), s);
    EXPECT_EQ(ns("04:51,5"), (4 * 60 + 51) * s + s / 2);
    EXPECT_EQ(ns("1970-01-02 00:00:01"), day + s);
    EXPECT_EQ(ns("1970/01/02T00:00:01.000000001"), day + s + 1);
    EXPECT_EQ(ns("02.01.1970 00:00:01"), day + s);
    EXPECT_EQ(ns("1970-01-02T01:00:00+01:00"), day);
    EXPECT_EQ(ns("01/13/1970 00:00:00"), 12 * day);
    EXPECT_EQ(ns("13/01/1970 00:00:00"), 12 * day);
    EXPECT_FALSE(clock_time_of("03/04/2020 00:00:00")->is_date_certain);
    for (const char* none : {"25:00:00", "12:60:00", "2020-02-30 00:00:00", "12:30", "1:2:3", "2020-03-16",
                             "2020-03-16 17:04:51 x", "17:04:51.", "13:00:00 PM", "12.5", "12.5.7"})
        EXPECT_FALSE(clock_time_of(none)) << none;
}

}  // namespace
}  // namespace fidservo
