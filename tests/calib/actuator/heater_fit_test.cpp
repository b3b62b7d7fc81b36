// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/heater_fit.h"

#include "core/failure.h"
#include "core/random.h"
#include "core/result.h"
#include "core/rig.h"
#include "reference/reference_rig.h"
#include "src/files/recording/reader.h"
#include "tests/calib/sweep.h"
#include "tests/shared_table.h"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace fidservo::calib {
namespace {

using testing::column;
using testing::shared_table;

/// Steps as in the paper: heated for 3 s at each of the voltages, cooled for 4 s, on the independent model.
HeaterRun step_responses(const Rig& rig, const reference::Departures& departures,
                         const std::vector<double>& volts, std::uint64_t seed) {
    constexpr int heating_ticks = 3000, period_ticks = 7000, substeps = 4;
    const reference::RigModel model = reference::make_rig_model(rig, departures, substeps);
    reference::State state = reference::start(model, 100.0, seed);
    HeaterRun run{.tick_s = rig.tick_s, .command = {}, .reading = {}};
    for (const double step_V : volts)
        for (int k = 0; k < period_ticks; ++k) {
            run.command.push_back(k < heating_ticks ? step_V : 0.0);
            run.reading.push_back(reference::sample(model, state).hall_adc);
            reference::advance(model, state, 0.0, run.command.back());
        }
    return run;
}

reference::Departures another_heater() {
    reference::Departures departures;
    departures.heater.gain = 0.93;
    departures.heater.heating_tau = 1.12;
    departures.heater.cooling_tau = 0.85;
    departures.heater.ambient_degC = 3.0;
    return departures;
}

constexpr std::array<double, heater_numbers> another_truth{1.3, 0.93 * 272.0, 1.12 * 0.55, 0.85, 25.0};

std::array<double, heater_numbers> numbers_of(const HeaterParameters& heater) {
    return {heater.onset_V, heater.gain_degC_per_V, heater.heating_tau_s, heater.cooling_tau_s,
            heater.ambient_degC};
}

TEST(HeaterFit, StepsOfTheIndependentModel_GiveBackItsHeater) {
    const Rig& rig = reference_rig();
    const auto fit = fit_heater(nominal_micro_model(*rig.micro),
                                {step_responses(rig, another_heater(), {1.5, 1.6, 1.7, 1.8}, 1)});
    ASSERT_TRUE(fit) << fit.error().text;
    EXPECT_TRUE(fit->refused.empty());
    const auto found = numbers_of(fit->heater);
    for (std::size_t i = 0; i < heater_numbers; ++i) {
        // The independent model's integration in sub-steps of 0.25 ms adds a relative error of 1e-5.
        EXPECT_NEAR(found[i], another_truth[i], 4.0 * fit->std[i] + 1e-5 * another_truth[i])
            << name_of(static_cast<HeaterNumber>(i));
        EXPECT_LT(fit->std[i], 0.005 * another_truth[i]) << name_of(static_cast<HeaterNumber>(i));
    }
    EXPECT_NEAR(fit->residual_rms, std::sqrt(0.16 + 1.0 / 12.0), 0.03);
}

TEST(HeaterFit, OneVoltageOnly_CannotSeparateOnsetAndGain) {
    const Rig& rig = reference_rig();
    const auto fit = fit_heater(nominal_micro_model(*rig.micro), {step_responses(rig, {}, {1.55, 1.55}, 2)});
    ASSERT_TRUE(fit) << fit.error().text;
    ASSERT_FALSE(fit->refused.empty());
    for (const HeaterRefusal& refusal : fit->refused) {
        EXPECT_TRUE(refusal.number == HeaterNumber::onset || refusal.number == HeaterNumber::gain);
        EXPECT_TRUE(std::isnan(fit->std[static_cast<std::size_t>(refusal.number)]));
        EXPECT_FALSE(refusal.reason.empty());
    }
    EXPECT_NEAR(fit->heater.cooling_tau_s, 1.0, 0.01);
}

TEST(HeaterFit, PlatformThatRests_IsRefused) {
    const Rig& rig = reference_rig();
    const auto fit = fit_heater(nominal_micro_model(*rig.micro), {step_responses(rig, {}, {1.0}, 2)});
    ASSERT_FALSE(fit);
    EXPECT_EQ(fit.error().reason, Reason::not_identifiable);
}

TEST(SlowHeaterFit, StandardErrors_AreTrue) {
    const Rig& rig = reference_rig();
    std::array<double, heater_numbers> squares{};
    constexpr int n = 16;
    for (std::uint64_t seed = 1; seed <= n; ++seed) {
        const auto fit = fit_heater(nominal_micro_model(*rig.micro),
                                    {step_responses(rig, another_heater(), {1.5, 1.65, 1.8}, seed)});
        ASSERT_TRUE(fit && fit->refused.empty()) << "seed " << seed;
        const auto found = numbers_of(fit->heater);
        for (std::size_t i = 0; i < heater_numbers; ++i)
            squares[i] += std::pow((found[i] - another_truth[i]) / fit->std[i], 2);
    }
    for (std::size_t i = 0; i < heater_numbers; ++i) {
        RecordProperty(std::string(name_of(static_cast<HeaterNumber>(i))), std::to_string(squares[i] / n));
        // 99.99 % of a chi-square law with 16 degrees of freedom, over 16; rounding to counts is no Gauss.
        EXPECT_LT(squares[i] / n, 2.9 * 1.5) << name_of(static_cast<HeaterNumber>(i));
        EXPECT_GT(squares[i] / n, 0.18) << name_of(static_cast<HeaterNumber>(i));
    }
}

HeaterRun run_of(const std::filesystem::path& folder) {
    const Recording recording = read_recording(folder);
    HeaterRun run{.tick_s = recording.tick_s, .command = {}, .reading = {}};
    for (const StageRow& row : recording.rows) {
        run.command.push_back(row.micro_command_V);
        run.reading.push_back(row.hall_adc);
    }
    return run;
}

TEST(SlowHeaterFit, Campaigns_GiveTheRigsNumbersFromAWrongStart) {
    const std::filesystem::path campaigns = std::filesystem::path(FIDSERVO_DATA_DIR) / "campaigns";
    if (!std::filesystem::is_directory(campaigns)) {
        EXPECT_EQ(std::getenv("FIDSERVO_REQUIRE_DATA"), nullptr) << "the shared data are absent";
        GTEST_SKIP() << "the shared data are absent";
    }
    MicroModel model = nominal_micro_model(*reference_rig().micro);
    model.heater = {1.25, 1.9, 1.2 * 272.0, 0.4, 1.3, 20.0};
    for (const auto& [name, cooling_tau_s] : {std::pair{"no-effect", 1.0}, std::pair{"airflow", 0.8}}) {
        SCOPED_TRACE(name);
        const auto fit = fit_heater(model, {run_of(campaigns / name / "micro-steps-1"),
                                            run_of(campaigns / name / "micro-triangle-1")});
        ASSERT_TRUE(fit) << fit.error().text;
        EXPECT_TRUE(fit->refused.empty());
        const std::array truth{1.3, 272.0, 0.55, cooling_tau_s, 22.0};
        const auto found = numbers_of(fit->heater);
        for (std::size_t i = 0; i < heater_numbers; ++i)
            EXPECT_NEAR(found[i], truth[i], 4.0 * fit->std[i] + 1e-5 * truth[i])
                << name_of(static_cast<HeaterNumber>(i));
        EXPECT_LT(fit->residual_rms, 0.5);
    }
}

TEST(InferredTemperature, FollowsTheWireWhereItMoves) {
    const Rig& rig = reference_rig();
    const MicroModel model = nominal_micro_model(*rig.micro);
    const HeaterRun run = step_responses(rig, {}, {1.5, 1.6}, 3);
    const std::vector<double> truth = predict_temperature(model.heater, run);
    const InferredTemperature wire = infer_temperature(model, run.reading);
    double squares = 0.0, weight = 0.0;
    std::size_t known = 0;
    for (std::size_t k = 0; k < truth.size(); ++k) {
        const double w = wire.sensitivity_lsb_per_degC[k];
        squares += w * w * std::pow(wire.temp_degC[k] - truth[k], 2);
        weight += w * w;
        known += w > 0.0;
    }
    EXPECT_GT(known, truth.size() / 10);
    EXPECT_LT(known, truth.size());
    // Averaged over 11 ms while the wire heats at up to 250 degC/s: a start for the fit, not its result.
    EXPECT_LT(std::sqrt(squares / weight), 2.0);
}

TEST(HeaterFitToTemperature, SimulatedThermometer_IsRecovered) {
    const HeaterParameters truth{0.4, 10.0, 6.0, 12.0, 25.0, 22.0};
    HeaterRun run{.tick_s = 0.05, .command = {}, .reading = {}};
    NoiseStream noise(5, "thermometer");
    for (int k = 0; k < 6000; ++k) {
        const int pulse = k / 1200;
        run.command.push_back((k / 600) % 2 == 0 ? 1.0 + 0.3 * pulse : 0.0);
    }
    run.reading = predict_temperature(truth, run);
    for (double& value : run.reading) value += 0.1 * noise.normal();
    const auto fit = fit_heater_to_temperature({run});
    ASSERT_TRUE(fit) << fit.error().text;
    const auto found = numbers_of(fit->heater), expected = numbers_of(truth);
    for (std::size_t i = 0; i < heater_numbers; ++i)
        EXPECT_NEAR(found[i], expected[i], 4.0 * fit->std[i] + 0.002 * expected[i])
            << name_of(static_cast<HeaterNumber>(i));
}

TEST(SlowHeaterFitToTemperature, RealSpring_IsPredictedOnTheHalfItWasNotFittedTo) {
    const auto rows = shared_table("sma/heating_AB0.csv", 1);
    if (rows.empty()) GTEST_SKIP() << "the shared data are absent";
    const std::vector<double> command = column(rows, 4);
    const std::vector<std::size_t> corrupt = corrupt_samples(command);
    // 32 samples of 100 to 1025 where the drive reaches 25; 14 isolated tens between zeros; an isolated 3
    // between 23s.
    EXPECT_EQ(corrupt.size(), 47U);
    HeaterRun run{.tick_s = 0.01,
                  .command = without_samples(command, corrupt),
                  .reading = column(rows, 1),
                  .weight = {},
                  .ambient_degC = column(rows, 2)};
    EXPECT_EQ(*std::max_element(run.command.begin(), run.command.end()), 25.0);
    const std::size_t n = run.reading.size();
    HeaterRun half = run;
    half.weight.assign(n, 0.0);
    std::fill_n(half.weight.begin(), n / 2, 1.0);
    const auto fit = fit_heater_to_temperature({half});
    ASSERT_TRUE(fit) << fit.error().text;
    run.start_degC = run.reading.front();
    const std::vector<double> model = predict_temperature(fit->heater, run);
    double squares = 0.0;
    for (std::size_t k = n / 2; k < n; ++k) squares += std::pow(model[k] - run.reading[k], 2);
    EXPECT_LT(fit->residual_rms, 1.1);  // degC, of a rise of 30
    const std::size_t held_out = n - n / 2;
    EXPECT_LT(std::sqrt(squares / static_cast<double>(held_out)), 1.4);
}

TEST(CorruptSamples, SpikesAreFound_StepsRampsAndPulsesAreNot) {
    std::vector<double> command;
    command.reserve(400);
    for (int k = 0; k < 400; ++k)
        command.push_back(k < 100 ? 0.0 : k < 200 ? 5.0 : k < 300 ? 0.1 * (k - 200) : 0.0);
    for (int k = 330; k < 334; ++k) command[static_cast<std::size_t>(k)] = 8.0;
    EXPECT_TRUE(corrupt_samples(command).empty());
    command[50] = 1000.0;
    command[150] = 0.0;
    command[250] = command[251] = 100.0;
    EXPECT_EQ(corrupt_samples(command), (std::vector<std::size_t>{50, 150, 250, 251}));
    const std::vector<double> clean = without_samples(command, corrupt_samples(command));
    EXPECT_EQ(clean[50], 0.0);
    EXPECT_EQ(clean[150], 5.0);
    EXPECT_NEAR(clean[251], 4.9, 1e-12);
}

TEST(HeaterFit, UselessData_AreRefused) {
    const MicroModel model = nominal_micro_model(*reference_rig().micro);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> flat(500, 1.0), holed(500, nan), huge(500, 1e300);
    for (const auto& [command, reading] :
         {std::pair{std::vector<double>{}, std::vector<double>{}}, std::pair{flat, flat},
          std::pair{holed, flat}, std::pair{flat, holed}, std::pair{huge, flat},
          std::pair{flat, std::vector<double>(3, 1.0)}}) {
        const std::vector<HeaterRun> runs{{.tick_s = 0.001, .command = command, .reading = reading}};
        const auto hall = fit_heater(model, runs), temperature = fit_heater_to_temperature(runs);
        ASSERT_FALSE(hall || temperature);
        EXPECT_EQ(hall.error().reason, Reason::not_identifiable);
        EXPECT_EQ(temperature.error().reason, Reason::not_identifiable);
    }
    EXPECT_FALSE(fit_heater(model, {}));
}

TEST(HeaterFit, RandomData_NeverBreakIt) {
    const MicroModel model = nominal_micro_model(*reference_rig().micro);
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        NoiseStream draw(seed, "robustness");
        const auto n = static_cast<std::size_t>(150.0 * draw.uniform());
        HeaterRun run{.tick_s = 0.01, .command = {}, .reading = {}};
        for (std::size_t k = 0; k < n; ++k) {
            run.command.push_back(5.0 * draw.uniform());
            run.reading.push_back(4095.0 * draw.uniform());
        }
        for (const auto& fit : {fit_heater(model, {run}), fit_heater_to_temperature({run})})
            if (fit) {
                EXPECT_TRUE(std::isfinite(fit->residual_rms));
            }
    }
}

}  // namespace
}  // namespace fidservo::calib
