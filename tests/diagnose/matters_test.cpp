// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/matters.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "src/diagnose/words.h"
#include "tests/reference_rig.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {

namespace {

using diagnose::what_matters;
using gap::index_of;
using gap::Signal;
using ::testing::HasSubstr;

TEST(WhatMatters, IsReadInTheSignalsUnit) {
    const Rig& rig = reference_rig();
    const gap::SignalLimits limits =
        what_matters({"encoder=20um", "tag=0.1px", "hall=2.5", "macro_command=3mV"}, rig);
    EXPECT_NEAR(limits[index_of(Signal::encoder)], 0.020 / rig.macro.encoder_resolution_mm, 1e-12);
    EXPECT_EQ(limits[index_of(Signal::tag)], 0.1);
    EXPECT_EQ(limits[index_of(Signal::hall)], 2.5);
    EXPECT_DOUBLE_EQ(limits[index_of(Signal::macro_command)], 0.003);
    EXPECT_EQ(limits[index_of(Signal::micro_command)], 0.0);
    const double um = what_matters({"hall=10um"}, rig)[index_of(Signal::hall)];
    EXPECT_NEAR(um * diagnose::hall_um_per_lsb(rig.micro->hall), 10.0, 1e-9);
}

TEST(WhatMatters, AnythingElse_IsRefusedWithWhatIsAllowed) {
    const Rig& rig = reference_rig();
    const auto refused = [&](const std::vector<std::string>& arguments, const std::string& what) {
        try {
            what_matters(arguments, rig);
            ADD_FAILURE() << arguments.front();
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr(what));
        }
    };
    refused({"force=1"}, "force: there is no such signal; there are encoder, hall, tag");
    refused({"encoder"}, "units: count, um, mm");
    refused({"encoder=20furlong"}, "units: count, um, mm");
    refused({"encoder=-1"}, "above 0");
    refused({"encoder=nan"}, "above 0");
    refused({"tag=0.1um"}, "units: px");
    refused({"tag=1", "tag=2"}, "tag is given twice");
}

}  // namespace

}  // namespace fidservo
