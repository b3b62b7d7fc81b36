// SPDX-License-Identifier: GPL-3.0-or-later
// Which windows of a wire of unknown history are judged. Its relays are known where it has been heated
// through the whole table; between two temperatures that it has been at, none of those that are not known
// switches.
#include "core/rig.h"
#include "gap/links/wire_memory.h"
#include "gap/links/wire_start.h"
#include "plant/effects/catalogue.h"
#include "tests/reference_rig.h"

#include <algorithm>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace fidservo {
namespace {

using namespace gap;

const PlatformModel& nominal() {
    static const PlatformModel model = platform_model(plant::plant_parameters(reference_rig()));
    return model;
}

constexpr std::size_t rows_a_second = 1000, seconds = 30;

/// Recorded after the same command was applied for long enough for the wire to be in its steady state.
PlatformRun run_of(WireStart start, const std::function<double(std::size_t)>& command_V_in_second) {
    PlatformRun run;
    run.tick_s = 1e-3;
    run.floor_lsb = 0.5;
    run.start = start;
    const std::size_t rows = rows_a_second * seconds;
    for (std::size_t k = 0; k < rows; ++k) {
        run.command_V.push_back(command_V_in_second(k / rows_a_second));
        run.macro_command_V.push_back(0.0);
        run.ticks.push_back(1);
    }
    plant::MicroStageState state = plant::start(nominal().stage, 0);
    PlatformRun before = run;
    before.command_V.assign(rows, run.command_V.front());
    for (std::size_t k = 0; k < rows; ++k) step(nominal(), before, nullptr, k, state);
    for (std::size_t k = 0; k < rows; ++k) {
        run.hall_adc.push_back(std::round(mean_reading_lsb(nominal().stage, state)));
        step(nominal(), run, nullptr, k, state);
    }
    for (std::size_t first = 100; first + rows_a_second <= rows; first += rows_a_second)
        run.windows.push_back({first - 100, first, first + rows_a_second});
    return run;
}

/// The unknown temperature at the start is forgotten after as many of the slowest time constants as make of
/// 30 degC a hundredth.
double forgotten_s() {
    const HeaterParameters& heater = nominal().stage.heater.parameters;
    return std::log(3000.0) * std::max(heater.heating_tau_s, heater.cooling_tau_s);
}

TEST(KnownMemory, ColdWire_KeepsAllWindows) {
    PlatformRun run = run_of(WireStart::cold, [](std::size_t second) { return second % 2 == 0 ? 0.0 : 1.5; });
    const std::size_t all = run.windows.size();
    keep_known_memory(run, nominal());
    EXPECT_EQ(run.windows.size(), all);
    EXPECT_TRUE(run.is_beside.empty());
}

TEST(KnownMemory, WireHeatedThroughItsWholeTable_IsKnownFromThenOn) {
    constexpr std::size_t heated_s = 14, until_s = 18;
    PlatformRun run = run_of(WireStart::warm, [](std::size_t second) {
        if (second >= heated_s && second < until_s) return nominal().stage.heater.parameters.limit_V;
        return second % 3 == 0 ? 1.4 : 1.5;
    });
    keep_known_memory(run, nominal());
    ASSERT_FALSE(run.windows.empty());
    std::size_t after = 0;
    for (std::size_t w = 0; w < run.windows.size(); ++w) {
        EXPECT_GE(run.windows[w].lead, static_cast<std::size_t>(forgotten_s() * rows_a_second) - 1);
        if (run.windows[w].lead < until_s * rows_a_second) continue;
        ++after;
        EXPECT_FALSE(run.is_beside[w]) << w;
    }
    EXPECT_EQ(after, seconds - until_s - 1) << "all windows after it was hot";
}

/// Nothing switches, but what the relays that are not known contribute is not known either.
TEST(KnownMemory, WireThatStaysWhereItWas_IsOffsetByAConstant) {
    PlatformRun run = run_of(WireStart::warm, [](std::size_t) { return 1.5; });
    keep_known_memory(run, nominal());
    ASSERT_FALSE(run.windows.empty());
    EXPECT_GE(run.windows.front().lead, static_cast<std::size_t>(forgotten_s() * rows_a_second) - 1);
    EXPECT_EQ(run.windows.size(), run.is_beside.size());
    EXPECT_TRUE(std::ranges::all_of(run.is_beside, std::identity{}));
}

/// While it goes on to temperatures that it has not been at, relays in unknown states switch. A relay counts
/// as known only with a margin of 2 degC to either side, which this wire takes three seconds for.
TEST(KnownMemory, WireThatGoesToNewTemperatures_IsNotJudgedOnTheWay) {
    constexpr std::size_t begins_s = 15;
    PlatformRun run = run_of(WireStart::warm, [](std::size_t second) {
        return second < begins_s ? 1.45 : 1.45 + 0.005 * static_cast<double>(second - begins_s);
    });
    keep_known_memory(run, nominal());
    for (const WindowRows& window : run.windows) EXPECT_LE(window.end, (begins_s + 4) * rows_a_second);
}

}  // namespace
}  // namespace fidservo
