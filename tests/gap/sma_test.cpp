// SPDX-License-Identifier: GPL-3.0-or-later
// A real wire, by other people: NiTi heated and cooled once under each of two loads. Its table is fitted to
// one load, and the diagnosis is asked about the other.
#include "calib/wire/preisach_fit.h"
#include "core/rig.h"
#include "gap/candidates/candidate.h"
#include "gap/diagnose.h"
#include "tests/reference_rig.h"
#include "tests/shared_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <regex>
#include <span>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace fidservo {

namespace {

using namespace gap;
using testing::column;
using testing::shared_table;

constexpr double mm_per_strain = 90.0;

/// Temperature, free of its noise's reversals, and the contraction, 4 mm short of the hot state's, in which
/// the strains of both loads are zero.
struct Loop {
    std::vector<double> temp_degC, contraction_mm;
};

Loop loop_of(const std::vector<std::vector<double>>& rows) {
    Loop loop{calib::without_small_reversals(column(rows, 0), calib::noise_reversal(column(rows, 0))), {}};
    const std::vector<double> strain = column(rows, 1);
    for (const double value : strain) loop.contraction_mm.push_back(4.0 - mm_per_strain * value);
    return loop;
}

/// A rig whose heater has any temperature within a tick, as there is a thermometer, and whose sensor is
/// straight.
Rig wire_with_thermometer(const calib::PreisachFit& fit) {
    Rig rig = reference_rig();
    rig.tick_s = 0.02;
    rig.camera.reset();
    rig.fiducials.reset();
    MicroParameters& micro = *rig.micro;
    micro.fod = std::make_shared<const FodTable>(fit.table);
    micro.heater = {.onset_V = 0.0,
                    .limit_V = 2.0,
                    .gain_degC_per_V = 100.0,
                    .heating_tau_s = 1e-4,
                    .cooling_tau_s = 1e-4,
                    .ambient_degC = 22.0};
    micro.hall.cubic = 0.0;
    micro.hall.noise_lsb =
        fit.residual_rms * hall_slope_V_per_mm(micro.hall, micro.hall.centre_mm) / hall_lsb_V(micro.hall);
    micro.pi.reset();
    return rig;
}

Recording recorded(const Loop& loop, const Rig& rig) {
    const MicroParameters& micro = *rig.micro;
    Recording recording;
    recording.name = "other-load";
    recording.tick_s = rig.tick_s;
    recording.columns = {.micro_command = true, .hall = true};
    for (std::size_t k = 0; k < loop.temp_degC.size(); ++k) {
        StageRow row{.time_ns = nanoseconds(rig.tick_s) * static_cast<TimeNs>(k)};
        const std::size_t next = std::min(k + 1, loop.temp_degC.size() - 1);
        row.micro_command_V =
            (loop.temp_degC[next] - micro.heater.ambient_degC) / micro.heater.gain_degC_per_V;
        row.hall_adc =
            std::round(hall_voltage_V(micro.hall, loop.contraction_mm[k]) / hall_lsb_V(micro.hall));
        recording.rows.push_back(row);
    }
    return recording;
}

/// What the diagnosis says that either half of the data makes of the shift.
std::pair<double, double> guessed_shifts(const Diagnosis& diagnosis) {
    const std::string text = diagnosis.unexplained ? diagnosis.unexplained->text : "";
    const std::regex pattern("shift_degC ([-0-9.]+) by one half of the data, ([-0-9.]+) by the other");
    std::smatch found;
    if (!std::regex_search(text, found, pattern)) return {std::nan(""), std::nan("")};
    return {std::stod(found[1]), std::stod(found[2])};
}

TEST(SlowSma, WireUnderMoreLoad_IsAShiftOfItsTemperatures) {
    const auto rows100 = shared_table("sma/filtered_data_100MPa.txt", 1);
    const auto rows150 = shared_table("sma/filtered_data_150MPa.txt", 1);
    if (rows100.empty() || rows150.empty()) GTEST_SKIP() << "the shared data are absent";
    const Loop known = loop_of(rows100), other = loop_of(rows150);
    const auto fit = calib::fit_preisach({known.temp_degC, known.contraction_mm}, {.nodes = 40});
    ASSERT_TRUE(fit) << fit.error().text;
    const Rig rig = wire_with_thermometer(*fit);

    const Diagnosis diagnosis = diagnose(Evidence(rig, {recorded(other, rig)}));
    // One loop, heated in one half of the data and cooled in the other, is too little to be sure.
    EXPECT_EQ(diagnosis.verdict, Verdict::unexplained);
    ASSERT_GE(diagnosis.candidates.size(), 2U);
    double probability = 0.0, of_others = 0.0;
    for (const TriedEffect& tried : std::span(diagnosis.candidates).first(2)) {
        EXPECT_EQ(class_of(tried.effect), class_of("stress_shift"));
        EXPECT_GT(tried.gap_removed, 0.9);
        probability += tried.probability;
    }
    for (const TriedEffect& tried : std::span(diagnosis.candidates).subspan(2))
        of_others = std::max(of_others, tried.probability);
    EXPECT_GT(probability, 2.0 * of_others);
    const auto [heated_degC, cooled_degC] = guessed_shifts(diagnosis);
    for (const double shift_degC : {heated_degC, cooled_degC})
        EXPECT_NEAR(std::abs(shift_degC) / (150.0 - 100.0), 0.12, 0.02);  // 7 to 10 MPa/degC for NiTi
    std::printf("heated: %.3f degC per MPa, cooled: %.3f\n", std::abs(heated_degC) / 50.0,
                std::abs(cooled_degC) / 50.0);
}

}  // namespace

}  // namespace fidservo
