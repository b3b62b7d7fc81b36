// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/wire_memory.h"

#include "core/preisach.h"
#include "gap/links/wire_start.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace fidservo::gap {

namespace {

/// For each row, what the relays in unknown states contribute at most, mm. Since a rig's heater may differ
/// from its file's, a relay counts as known only where the temperature passed its threshold by a margin.
std::vector<double> unknown_mm(const PlatformRun& run, const PlatformModel& nominal) {
    constexpr double most_off_degC = 30.0, enough_degC = 0.01;
    constexpr double margin_degC = 2.0;
    const double enough_taus = std::log(most_off_degC / enough_degC);
    const FodTable& table = *nominal.stage.fod;
    const HeaterParameters& heater = nominal.stage.heater.parameters;
    std::vector<double> unknown_mm(run.command_V.size(), table.stroke_mm());
    plant::MicroStageState state = first_state(nominal, run);
    const double slowest_tau_s = std::max(heater.heating_tau_s, heater.cooling_tau_s);
    double taus = 0.0, highest_degC = table.low_degC(), lowest_degC = table.high_degC();
    for (std::size_t k = 0; k < run.command_V.size(); ++k) {
        const double temp_degC =
            std::clamp(table_degC(nominal.stage, state), table.low_degC(), table.high_degC());
        if (taus >= enough_taus) {
            highest_degC = std::max(highest_degC, temp_degC - margin_degC);
            lowest_degC = std::min(lowest_degC, temp_degC + margin_degC);
            unknown_mm[k] = table.contraction_mm(table.high_degC(), lowest_degC) -
                            table.contraction_mm(std::max(highest_degC, lowest_degC), lowest_degC);
        }
        taus += run.ticks[k] * run.tick_s / slowest_tau_s;
        step(nominal, run, nullptr, k, state);
    }
    return unknown_mm;
}

}  // namespace

void keep_known_memory(PlatformRun& run, const PlatformModel& nominal) {
    if (run.windows.empty() || run.start != WireStart::warm) return;
    const std::vector<double> unknown = unknown_mm(run, nominal);
    const double floor_mm = run.floor_lsb * mm_per_lsb(nominal.stage.hall.parameters);
    const double enough_mm = 0.5 * floor_mm;
    std::vector<WindowRows> known;
    std::vector<bool> is_beside;
    for (const WindowRows& window : run.windows) {
        if (unknown[window.lead] - unknown[window.end - 1] > enough_mm) continue;
        if (unknown[window.lead] >= nominal.stage.fod->stroke_mm()) continue;
        known.push_back(window);
        is_beside.push_back(unknown[window.lead] > enough_mm);
    }
    run.windows = std::move(known);
    run.is_beside = std::move(is_beside);
}

}  // namespace fidservo::gap
