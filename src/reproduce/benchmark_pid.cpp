// SPDX-License-Identifier: GPL-3.0-or-later
// The benchmark PID and its stick-slip limit cycle (fig. 17).
#include "core/random.h"
#include "core/rig.h"
#include "src/reproduce/chapters.h"
#include "src/reproduce/figures.h"
#include "src/reproduce/step_response.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::reproduce {

namespace {

constexpr double cycling_duration_s = 30.0, cycling_tail_s = 20.0;

/// The carriage stands off its set point for a while, then breaks away.
struct Stick {
    double from_s, to_s;
    double error_mm;  ///< set point - carriage, while it stands
};

std::vector<Stick> sticks_of(const std::vector<double>& carriage, double target_mm, double tick_s) {
    constexpr double least_s = 0.2;
    std::vector<Stick> sticks;
    std::size_t since = 0;
    for (std::size_t k = 1; k < carriage.size(); ++k) {
        if (carriage[k] == carriage[k - 1]) continue;
        const Stick stick{tick_s * static_cast<double>(since), tick_s * static_cast<double>(k),
                          target_mm - carriage[k - 1]};
        if (stick.to_s - stick.from_s >= least_s && stick.error_mm != 0.0) sticks.push_back(stick);
        since = k;
    }
    return sticks;
}

/// One step under the PID.
struct Run {
    Recording recording;
    std::vector<double> carriage_mm;
    StepResponse response;
    std::vector<Stick> sticks;
    long sticks_in_tail;

    bool cycles(double count_mm) const {
        return sticks_in_tail >= 3 && response.tail_peak_to_peak > 2.0 * count_mm;
    }
};

Run run_step(const Laboratory& laboratory, double start_mm, double step_mm, const std::string& name) {
    const Rig& rig = laboratory.rig;
    const double count_mm = rig.macro.encoder_resolution_mm;
    const double from_mm = count_mm * std::floor(start_mm / count_mm + 0.5), target_mm = from_mm + step_mm;
    Run run{.recording = perform(laboratory, name,
                                 {.kind = "pid-step",
                                  .duration_s = cycling_duration_s,
                                  .carriage_mm = start_mm,
                                  .macro_setpoint_mm = [=](double) { return target_mm; },
                                  .macro_loop = MacroLoop::benchmark_pid}),
            .carriage_mm = {},
            .response = {},
            .sticks = {},
            .sticks_in_tail = 0};
    run.carriage_mm = carriage_mm(rig, run.recording);
    run.response = step_response(run.carriage_mm, from_mm, target_mm, count_mm, cycling_tail_s, rig.tick_s);
    run.sticks = sticks_of(run.carriage_mm, target_mm, rig.tick_s);
    run.sticks_in_tail = std::ranges::count_if(
        run.sticks, [](const Stick& stick) { return stick.to_s > cycling_duration_s - cycling_tail_s; });
    return run;
}

/// Steps of several sizes. Where in a count the carriage starts is drawn: nobody can choose it.
std::vector<Run> run_steps(const Laboratory& laboratory) {
    constexpr std::array steps_mm{20.0, 10.0, 30.0, 38.85, 45.0, 50.0};
    NoiseStream place(laboratory.seed, "reproduce/pid");
    std::vector<Run> runs;
    runs.reserve(steps_mm.size());
    for (const double step_mm : steps_mm)
        runs.push_back(run_step(laboratory,
                                100.0 + laboratory.rig.macro.encoder_resolution_mm * (place.uniform() - 0.5),
                                step_mm, fmt::format("pid-step-{:.0f}mm", step_mm)));
    return runs;
}

std::string table_of(const std::vector<Run>& runs, double count_mm) {
    std::vector<std::vector<std::string>> rows;
    rows.reserve(runs.size());
    for (const Run& run : runs)
        rows.push_back({fmt::format("{:.2f}", run.response.to - run.response.from),
                        fmt::format("{:.2f}", run.response.overshoot), std::to_string(run.sticks.size()),
                        fmt::format("{:.2f}", run.response.tail_peak_to_peak),
                        run.cycles(count_mm) ? "limit cycle" : "stands"});
    return table_html({"step, mm", "overshoot, mm", "stood off the set point, times",
                       fmt::format("peak to peak in the last {:.0f} s, mm", cycling_tail_s), "ends as"},
                      rows);
}

}  // namespace

Chapter benchmark_pid(const Laboratory& laboratory) {
    const Rig& rig = laboratory.rig;
    const double count_mm = rig.macro.encoder_resolution_mm;
    const std::vector<Run> runs = run_steps(laboratory);
    const auto shown = std::ranges::find_if(runs, [&](const Run& run) { return run.cycles(count_mm); });
    const Run& run = shown == runs.end() ? runs.front() : *shown;
    const auto cycling = std::ranges::count_if(runs, [&](const Run& r) { return r.cycles(count_mm); });
    const auto overshooting =
        std::ranges::count_if(runs, [&](const Run& r) { return r.response.overshoot > count_mm; });
    const auto standing = std::ranges::count_if(runs, [](const Run& r) { return !r.sticks.empty(); });
    double longest_s = 0.0;
    for (const Run& r : runs)
        for (const Stick& stick : r.sticks) longest_s = std::max(longest_s, stick.to_s - stick.from_s);

    Chapter chapter{"pid", "The benchmark PID: a stick-slip limit cycle", "", {}};
    chapter.html =
        time_figure("pid-step",
                    fmt::format("Fig. 17 from our data: a step of {:.2f} mm under the PID. It rises fast and "
                                "overshoots; then the "
                                "carriage stands while the integral ramps up through the dead zone, breaks "
                                "away, passes the set "
                                "point, and sticks; the integral turns round, and so it goes on.",
                                run.response.to - run.response.from),
                    rig.tick_s,
                    {{"Carriage",
                      "mm",
                      {{"set point", column(run.recording, &StageRow::macro_setpoint_mm), true, 2, true},
                       {"carriage (encoder)", run.carriage_mm, false, 2}}},
                     {"Motor command",
                      "V",
                      {{"motor", column(run.recording, &StageRow::macro_command_V), true}},
                      160}}) +
        table_of(runs, count_mm) +
        "<p class=\"caption\">A step that happens to end on the very count of its set point stands: the "
        "encoder shows no error, "
        "and the integral rests.</p>";
    chapter.claims = {
        {"fig. 17", "The carriage does not move while the integral ramps up through the friction.",
         fmt::format("in {} of {} steps it stood off the set point, up to {:.1f} s", standing, runs.size(),
                     longest_s),
         holds_if(standing == std::ssize(runs)), ""},
        {"fig. 17", "It overshoots.",
         fmt::format("in {} of {} steps; {:.2f} mm on {:.0f} mm", overshooting, runs.size(),
                     runs.back().response.overshoot, runs.back().response.to - runs.back().response.from),
         holds_if(overshooting == std::ssize(runs)), ""},
        {"fig. 17", "It ends in a limit cycle about the set point, stick and slip in turn.",
         fmt::format("{} of {} steps; the one shown passes {:.2f} mm from peak to peak, {} times in {:.0f} s",
                     cycling, runs.size(), run.response.tail_peak_to_peak, run.sticks_in_tail,
                     cycling_tail_s),
         holds_if(2 * cycling >= std::ssize(runs)), ""}};
    return chapter;
}

}  // namespace fidservo::reproduce
