// SPDX-License-Identifier: GPL-3.0-or-later
// Speed of the stage's physics, without images: how many times faster than the rig one core simulates it,
// beside the limit of 3,000; and the cost of the wire's hysteresis per sample, beside a direct evaluation of
// the double integral over relays on the same grid.
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"
#include "plant/stage_plant.h"
#include "src/files/rig/rig_file.h"
#include "tests/core_time.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <vector>

#include <benchmark/benchmark.h>
#include <time.h>

namespace {

using namespace fidservo;

constexpr double least_times_real_time = 3000.0;

const Rig& reference_rig() {
    static const Rig rig = load_rig(FIDSERVO_ASSETS_DIR "/rig.yaml");
    return rig;
}

struct Command {
    double macro_V;
    double micro_V;
};

/// A minute of commands like those of closed loops: the carriage goes to and fro, the wire goes to random
/// levels and its command jitters with the sensor's noise.
std::vector<Command> busy_commands() {
    NoiseStream noise(7, "commands");
    std::vector<Command> commands(60000);
    double level_V = 1.6;
    for (std::size_t k = 0; k < commands.size(); ++k) {
        if (k % 300 == 0) level_V = 1.35 + 0.5 * noise.uniform();
        commands[k] = {4.5 * std::sin(2.0 * std::numbers::pi * static_cast<double>(k) / 900.0),
                       std::clamp(level_V + 0.003 * noise.normal(), 1.3, 1.9)};
    }
    return commands;
}

/// Runs blocks of one simulated second, and reports the times real time of the median, the 99th percentile of
/// slowness and the slowest block.
template <class Tick>
void run_seconds(benchmark::State& bench, Tick tick) {
    const std::vector<Command> commands = busy_commands();
    const int ticks_per_s = static_cast<int>(std::lround(1.0 / reference_rig().tick_s));
    std::vector<double> speeds;
    std::size_t next = 0;
    for (auto _ : bench) {
        const double begin_s = core_time_s();
        for (int k = 0; k < ticks_per_s; ++k) {
            tick(commands[next]);
            next = next + 1 == commands.size() ? 0 : next + 1;
        }
        speeds.push_back(1.0 / (core_time_s() - begin_s));
    }
    std::sort(speeds.begin(), speeds.end());
    bench.SetItemsProcessed(bench.iterations() * ticks_per_s);
    bench.counters["x_real_time"] = speeds[speeds.size() / 2];
    bench.counters["x_p99"] = speeds[speeds.size() / 100];
    bench.counters["x_worst"] = speeds.front();
    bench.counters["x_limit"] = least_times_real_time;
}

void stage_tick(benchmark::State& bench) {
    const plant::StagePlant plant = plant::make_stage_plant(reference_rig());
    plant::StageState state = plant::start(plant, 100.0, 1);
    run_seconds(bench, [&](const Command& command) {
        benchmark::DoNotOptimize(plant::sample(plant, state));
        plant::advance(plant, state, command.macro_V, command.micro_V);
    });
}
BENCHMARK(stage_tick)->Unit(benchmark::kMicrosecond);

/// Where a tick's time goes.
void stage_tick_macro_only(benchmark::State& bench) {
    const plant::StagePlant plant = plant::make_stage_plant(reference_rig());
    plant::StageState state = plant::start(plant, 100.0, 1);
    run_seconds(bench, [&](const Command& command) {
        benchmark::DoNotOptimize(plant::sample(plant.encoder, state.encoder, state.axis.position_mm));
        plant::advance(plant.axis, state.axis, command.macro_V);
    });
}
BENCHMARK(stage_tick_macro_only)->Unit(benchmark::kMicrosecond);

/// The carriage with effects that have no closed form, "+" between them.
void stage_tick_with_effects(benchmark::State& bench, std::string_view names) {
    std::vector<plant::EffectSetting> effects;
    while (!names.empty()) {
        const std::size_t end = std::min(names.find('+'), names.size());
        effects.push_back(plant::parse_effect(names.substr(0, end)));
        names.remove_prefix(std::min(end + 1, names.size()));
    }
    const plant::StagePlant plant = plant::make_stage_plant(reference_rig(), effects);
    plant::StageState state = plant::start(plant, 100.0, 1);
    run_seconds(bench, [&](const Command& command) {
        benchmark::DoNotOptimize(plant::sample(plant.encoder, state.encoder, state.axis.position_mm));
        plant::advance(plant.axis, state.axis, command.macro_V);
    });
}
BENCHMARK_CAPTURE(stage_tick_with_effects, delay, "drive_delay:delay_ms=3.7")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_with_effects, coulomb, "coulomb_friction")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_with_effects, stribeck, "stribeck_friction")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_with_effects, creep, "stribeck_friction:level_V=0.4,creep_mm_per_s=0.4")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_with_effects, presliding, "presliding")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_with_effects, cogging, "cogging")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_with_effects, belt, "belt_compliance")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_with_effects, stiff_belt, "belt_compliance:stretch_um_per_V=0.5")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_with_effects, backlash, "backlash")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_with_effects, all,
                  "drive_delay+coulomb_friction+stribeck_friction+friction_asymmetry+presliding+rail_patch+"
                  "cogging+cable_force+belt_compliance+backlash+encoder_ripple")
    ->Unit(benchmark::kMicrosecond);

/// The whole stage with an effect of the catalogue, and with the same one written as a formula.
void stage_tick_with(benchmark::State& bench, const plant::EffectSetting& effect) {
    const plant::StagePlant plant = plant::make_stage_plant(reference_rig(), {&effect, 1});
    plant::StageState state = plant::start(plant, 100.0, 1);
    run_seconds(bench, [&](const Command& command) {
        benchmark::DoNotOptimize(plant::sample(plant, state));
        plant::advance(plant, state, command.macro_V, command.micro_V);
    });
}

void stage_tick_listed(benchmark::State& bench, std::string_view effect) {
    stage_tick_with(bench, plant::parse_effect(effect));
}

void stage_tick_formula(benchmark::State& bench, const char* port, const char* block, const char* formula,
                        double size) {
    FormulaEffect text;
    text.name = "formula";
    text.acts_on = port;
    text.block = block;
    text.formula = formula;
    text.parameters.push_back({.name = "size", .low = -10.0, .high = 10.0, .typical = size});
    stage_tick_with(bench, plant::typical_setting(plant::effect_of(text)));
}
BENCHMARK_CAPTURE(stage_tick_listed, friction_asymmetry,
                  "friction_asymmetry:right_V_s_per_mm=0.002,left_V_s_per_mm=0.001")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_formula, friction_asymmetry, "macro.friction", "macro.friction",
                  "size * speed * (direction > 0 ? 1 : 0.5)", 0.002)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_listed, stribeck, "stribeck_friction")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_formula, stribeck, "macro.friction", "macro.friction",
                  "size * exp(-abs(speed) / 12) * direction", 0.2)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_listed, cogging, "cogging")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_formula, cogging, "macro.force", "macro.mechanics",
                  "size * sin(2 * pi * place / 5)", 0.1)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_listed, stress_shift, "stress_shift:shift_degC=5")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_formula, stress_shift, "micro.transformation", "micro.hysteresis", "size", 5.0)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_listed, hall_drift, "hall_drift")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(stage_tick_formula, hall_drift, "micro.hall_voltage", "micro.hall", "size * time", 0.001)
    ->Unit(benchmark::kMicrosecond);

void stage_tick_micro_only(benchmark::State& bench) {
    const plant::StagePlant plant = plant::make_stage_plant(reference_rig());
    plant::StageState state = plant::start(plant, 100.0, 1);
    run_seconds(bench,
                [&](const Command& command) { plant::advance(*plant.micro, *state.micro, command.micro_V); });
    benchmark::DoNotOptimize(state);
}
BENCHMARK(stage_tick_micro_only)->Unit(benchmark::kMicrosecond);

void stage_hall_reading(benchmark::State& bench) {
    const plant::StagePlant plant = plant::make_stage_plant(reference_rig());
    plant::StageState state = plant::start(plant, 100.0, 1);
    double position_mm = 0.0;
    run_seconds(bench, [&](const Command& command) {
        position_mm = command.micro_V;
        benchmark::DoNotOptimize(plant::sample(plant.micro->hall, state.micro->hall_noise, position_mm));
    });
}
BENCHMARK(stage_hall_reading)->Unit(benchmark::kMicrosecond);

/// Random temperatures on the table's nodes, where both evaluations are exact.
std::vector<double> random_history_degC(std::size_t length) {
    const FodTable& table = *reference_rig().micro->fod;
    NoiseStream noise(3, "temperature");
    std::vector<double> history(length);
    for (double& temp : history)
        temp = table.low_degC() +
               table.step_degC() * std::floor(noise.uniform() * static_cast<double>(table.nodes()));
    return history;
}

/// The double integral of the Preisach density over the relays that are on, cell by cell: a relay (up, down)
/// goes on when the temperature reaches up, off when it falls to down.
class RelayGrid {
  public:
    explicit RelayGrid(const FodTable& table) : cells_(table.nodes() - 1), table_(table) {
        for (std::size_t up = 0; up < cells_; ++up)
            for (std::size_t down = 0; down <= up; ++down) {
                weights_mm_.push_back(table.node_mm(up + 1, down + 1) - table.node_mm(up + 1, down) -
                                      table.node_mm(up, down + 1) + table.node_mm(up, down));
                on_.push_back(0);
            }
    }

    double step(double temp_degC) {
        const auto node =
            static_cast<std::size_t>(std::lround((temp_degC - table_.low_degC()) / table_.step_degC()));
        double contraction_mm = 0.0;
        std::size_t relay = 0;
        for (std::size_t up = 0; up < cells_; ++up)
            for (std::size_t down = 0; down <= up; ++down, ++relay) {
                if (up < node) on_[relay] = 1;
                if (down >= node) on_[relay] = 0;
                contraction_mm += on_[relay] * weights_mm_[relay];
            }
        return contraction_mm;
    }

  private:
    std::size_t cells_;
    const FodTable& table_;
    std::vector<double> weights_mm_;
    std::vector<std::uint8_t> on_;
};

void preisach_memory_of_extrema(benchmark::State& bench) {
    const FodTable& table = *reference_rig().micro->fod;
    const auto history = random_history_degC(static_cast<std::size_t>(bench.range(0)));
    for (auto _ : bench) {
        PreisachMemory memory = preisach_start(table, table.low_degC());
        for (const double temp_degC : history)
            benchmark::DoNotOptimize(preisach_step(table, memory, temp_degC));
    }
    bench.SetItemsProcessed(bench.iterations() * bench.range(0));
}
BENCHMARK(preisach_memory_of_extrema)
    ->RangeMultiplier(10)
    ->Range(1000, 1000000)
    ->Unit(benchmark::kMicrosecond);

void preisach_double_integral(benchmark::State& bench) {
    const FodTable& table = *reference_rig().micro->fod;
    const auto history = random_history_degC(static_cast<std::size_t>(bench.range(0)));
    RelayGrid checked(table);
    PreisachMemory memory = preisach_start(table, table.low_degC());
    for (const double temp_degC : history) {
        constexpr double rounding_mm = 1e-9;
        if (std::abs(checked.step(temp_degC) - preisach_step(table, memory, temp_degC)) > rounding_mm) {
            bench.SkipWithError("the two evaluations differ");
            return;
        }
    }
    for (auto _ : bench) {
        RelayGrid relays(table);
        for (const double temp_degC : history) benchmark::DoNotOptimize(relays.step(temp_degC));
    }
    bench.SetItemsProcessed(bench.iterations() * bench.range(0));
}
BENCHMARK(preisach_double_integral)->Arg(1000)->Arg(10000)->Unit(benchmark::kMicrosecond);

/// The longest memory there is: every cycle is a little smaller than the last, none is wiped out.
void preisach_shrinking_cycles(benchmark::State& bench) {
    const FodTable& table = *reference_rig().micro->fod;
    const auto cycles = bench.range(0);
    const double shrink_degC = 40.0 / static_cast<double>(cycles);
    for (auto _ : bench) {
        PreisachMemory memory = preisach_start(table, table.low_degC());
        for (std::int64_t k = 0; k < cycles; ++k) {
            preisach_step(table, memory, 110.0 - shrink_degC * static_cast<double>(k));
            benchmark::DoNotOptimize(
                preisach_step(table, memory, 20.0 + shrink_degC * static_cast<double>(k)));
        }
    }
    bench.SetItemsProcessed(bench.iterations() * 2 * cycles);
}
BENCHMARK(preisach_shrinking_cycles)->RangeMultiplier(10)->Range(100, 10000)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
