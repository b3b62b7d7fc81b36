// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/rig.h"
#include "src/files/rig/rig_file.h"
#include "src/identify/identify.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

Rig reference() {
    return load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
}

TextTable table_of(std::vector<TableColumn> columns) {
    return {"table.csv", std::move(columns)};
}

const IdentifiedValue& value_of(const Identified& identified, std::string_view key) {
    const auto found = std::ranges::find(identified.values, key, &IdentifiedValue::key);
    if (found == identified.values.end()) throw std::out_of_range(std::string(key));
    return *found;
}

/// The reference rig's Hall sensor read every 0.1 mm.
TextTable hall_table(double low_mm, double high_mm, const char* unit, double units_per_mm) {
    const HallParameters hall = reference().micro->hall;
    TableColumn input{"input", unit, {}}, output{"output", "adc", {}};
    for (double x_mm = low_mm; x_mm <= high_mm; x_mm += 0.02) {
        input.values.push_back(x_mm * units_per_mm);
        output.values.push_back(std::round(hall_voltage_V(hall, x_mm) / hall_lsb_V(hall)));
    }
    return table_of({std::move(input), std::move(output)});
}

TEST(CalibrateHall, TableInMicrometres_GivesTheCurveInTheRigFilesUnits) {
    const Identified hall = calibrate_hall({reference(), {}, hall_table(0.0, 4.0, "um", 1000.0), 1.0});
    EXPECT_TRUE(hall.undetermined.empty());
    for (const auto& [key, truth] :
         {std::pair{"micro.hall.mid_V", 2.5}, std::pair{"micro.hall.span_V", 1.25},
          std::pair{"micro.hall.centre_mm", 2.0}, std::pair{"micro.hall.cubic", 0.12}}) {
        const IdentifiedValue& value = value_of(hall, key);
        EXPECT_NEAR(value.value, truth, 4.0 * value.std) << key;
        EXPECT_TRUE(value.in_rig_file);
    }
    EXPECT_LT(hall.residuals.at(0).rms, 0.35);
    EXPECT_THAT(hall.notes.at(0), HasSubstr("1.953 um per bit on average"));
}

TEST(CalibrateHall, MiddleOnly_ListsWhatIsNotDetermined) {
    const Identified hall = calibrate_hall({reference(), {}, hall_table(1.8, 2.2, "mm", 1.0), 1.0});
    EXPECT_EQ(hall.values.size(), 2U);
    ASSERT_EQ(hall.undetermined.size(), 2U);
    EXPECT_EQ(hall.undetermined[0].key, "micro.hall.centre_mm");
}

TEST(CalibrateHall, NoReference_IsTheUsersMistake) {
    EXPECT_THAT(message_of([] {
                    return calibrate_hall({reference(), {}, std::nullopt, 0.0});
                }),
                HasSubstr("reference"));
    Rig rig = reference();
    rig.micro.reset();
    EXPECT_THAT(message_of([&] {
                    return calibrate_hall({rig, {}, std::nullopt, 0.0});
                }),
                HasSubstr("no Hall sensor"));
}

/// Temperature and contraction of the rig's wire over kiln cycles, read by an encoder of 14 um.
TextTable kiln_table() {
    const Rig rig = reference();
    PreisachMemory wire = preisach_start(*rig.micro->fod, 20.0);
    TableColumn input{"input", "degC", {}}, output{"output", "um", {}};
    for (double peak = 116.0; peak > 60.0; peak -= 6.0)
        for (double way = 0.0; way < 2.0 * (peak - 20.0); way += 0.2) {
            const double temp = 20.0 + std::min(way, 2.0 * (peak - 20.0) - way);
            input.values.push_back(temp);
            output.values.push_back(14.0 *
                                    std::round(1000.0 * preisach_step(*rig.micro->fod, wire, temp) / 14.0));
        }
    return table_of({std::move(input), std::move(output)});
}

TEST(SlowIdentifyHysteresis, KilnCycles_GiveTheRigsTable) {
    const Identified hysteresis = identify_hysteresis({reference(), {}, kiln_table(), 1.0});
    ASSERT_NE(hysteresis.fod, nullptr);
    EXPECT_THAT(hysteresis.notes.at(0), HasSubstr("10 descending curves"));
    const Rig rig = reference();
    const FodTable& truth = *rig.micro->fod;
    double squares = 0.0, count = 0.0;
    for (double a = 24.0; a <= 112.0; a += 4.0)
        for (double b = 22.0; b <= a; b += 4.0) {
            squares += std::pow(hysteresis.fod->contraction_mm(a, b) - truth.contraction_mm(a, b), 2);
            count += 1.0;
        }
    EXPECT_LT(std::sqrt(squares / count), 0.012);  // mm
    EXPECT_LT(hysteresis.residuals.at(0).rms, 0.010);
}

TEST(IdentifyHysteresis, ShortTable_SaysWhatIsMissing) {
    const Identified hysteresis = identify_hysteresis(
        {reference(), {}, table_of({{"input", "degC", {1.0, 2.0}}, {"output", "mm", {0.0, 1.0}}}), 1.0});
    ASSERT_EQ(hysteresis.undetermined.size(), 1U);
    EXPECT_THAT(hysteresis.undetermined[0].reason, HasSubstr("samples"));
    EXPECT_EQ(hysteresis.fod, nullptr);
}

TEST(IdentifyHeater, TableWithSpikes_StatesThemAndTheHeater) {
    TableColumn input{"input", "", {}}, output{"output", "degC", {}};
    double temp = 22.0;
    for (int k = 0; k < 4000; ++k) {
        const int pulse = k / 1000;
        const double drive = (k / 500) % 2 == 0 ? 4.0 + pulse : 0.0;
        input.values.push_back(k % 700 == 650 ? 1025.0 : drive);
        output.values.push_back(temp);
        const double way = 10.0 * drive - (temp - 22.0);
        temp += way * -std::expm1(-0.1 / (way > 0.0 ? 5.0 : 9.0));
    }
    const Identified heater =
        identify_heater({reference(), {}, table_of({std::move(input), std::move(output)}), 10.0});
    EXPECT_THAT(heater.notes.at(0), HasSubstr("5 of 4000 commands are corrupt"));
    EXPECT_NEAR(value_of(heater, "micro.heater.heating_tau_s").value, 5.0, 0.05);
    EXPECT_NEAR(value_of(heater, "micro.heater.cooling_tau_s").value, 9.0, 0.05);
    EXPECT_FALSE(value_of(heater, "micro.heater.cooling_tau_s").in_rig_file);
}

TEST(IdentifyHeater, RecordingWithoutHall_IsTheUsersMistake) {
    EXPECT_THAT(message_of([] {
                    return identify_heater({reference(), {Recording{}}, std::nullopt, 0.0});
                }),
                HasSubstr("hall [adc]"));
}

}  // namespace
}  // namespace fidservo
