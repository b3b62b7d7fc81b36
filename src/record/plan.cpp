// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/record/plan.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "src/files/disk/sha256.h"
#include "src/files/recording/description.h"
#include "src/files/rig/rig_file.h"
#include "src/files/rig/stage_keys.h"
#include "src/record/foresight.h"
#include "src/record/start.h"
#include "src/session/home.h"
#include "src/session/motion_params.h"
#include "src/session/stage_choice.h"
#include "src/simulation/experiment_file.h"
#include "src/simulation/planned_experiments.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

namespace fs = std::filesystem;

/// A wire that is simulated cannot be damaged.
std::optional<double> wire_limit_degC(const SessionOptions& options, const Rig& rig) {
    if (stage_is_simulated(options)) return std::nullopt;
    return watchdog_params(rig, load_stage_keys(options.rig_file).watchdog).wire_limit_degC;
}

/// The SHA-256 of the rig's files, of the seed and of the experiment's commands, tick by tick.
std::string request_of(const SessionOptions& session, const Rig& rig, const Experiment& experiment) {
    std::string asked = fmt::format("{} ", session.seed);
    for (const fs::path& file : files_of_rig(session.rig_file)) asked += sha256_of_file(file);
    const auto add = [&](double value) {
        const auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
        asked.append(bytes.data(), bytes.size());
    };
    add(experiment.carriage_mm);
    const auto ticks = static_cast<std::int64_t>(std::llround(experiment.duration_s / rig.tick_s));
    for (std::int64_t tick = 0; tick < ticks; ++tick)
        for (const Course* course : {&experiment.macro_setpoint_mm, &experiment.macro_V,
                                     &experiment.micro_setpoint_mm, &experiment.micro_V})
            add(value_at(*course, static_cast<double>(tick) * rig.tick_s));
    return sha256(asked);
}

PlannedRun planned(const ExperimentOptions& options, const Rig& rig, const std::string& name,
                   const fs::path& folder, Experiment experiment) {
    std::string request = request_of(options.session, rig, experiment);
    return {name, folder, std::move(experiment), std::move(request)};
}

/// The experiment of a kind or of a file.
DrawnExperiment one_experiment(const ExperimentOptions& options, const Rig& rig,
                               std::optional<double> limit_degC) {
    const std::string& asked = options.experiment;
    if (!is_experiment_file(asked))
        return draw_for(rig, asked, options.session.seed, asked + "-1", limit_degC);
    Experiment experiment = load_experiment(asked, rig);
    auto why = why_not(rig, experiment, limit_degC);
    return {std::move(experiment), std::move(why)};
}

/// What each of a campaign's experiments commands, but for those that the rig cannot do.
RecordPlan campaign(const ExperimentOptions& options, const Rig& rig, std::optional<double> limit_degC) {
    RecordPlan plan;
    for (const auto& [kind, name] : campaign_runs(rig)) {
        DrawnExperiment drawn = draw_for(rig, kind, options.session.seed, name, limit_degC);
        if (drawn.why_not)
            plan.left_out.push_back(fmt::format("{}: {}", name, *drawn.why_not));
        else
            plan.runs.push_back(planned(options, rig, name, options.out / name, std::move(drawn.experiment)));
    }
    if (plan.runs.empty())
        throw InputError(fmt::format("campaign: the rig {} can do none of it: {}", rig.name,
                                     fmt::join(plan.left_out, "; ")));
    return plan;
}

}  // namespace

bool is_campaign(const ExperimentOptions& options) {
    return options.experiment == whole_campaign;
}

bool heats(const Experiment& experiment) {
    return experiment.micro_V || experiment.micro_setpoint_mm;
}

RecordPlan plan_recordings(const ExperimentOptions& options, const Rig& rig, const Plate& plate) {
    (void)positioner_params(rig, 1.0);  // refuses a rig that cannot be homed
    if (registration_tags(rig, plate).empty())
        throw InputError(
            fmt::format("{}: fiducials: none can be brought into view on the travel, {} to {} mm: "
                        "the carriage's place cannot be registered",
                        options.session.rig_file.string(), rig.macro.low_mm, rig.macro.high_mm));
    const auto limit_degC = wire_limit_degC(options.session, rig);
    if (is_campaign(options)) return campaign(options, rig, limit_degC);
    DrawnExperiment drawn = one_experiment(options, rig, limit_degC);
    if (drawn.why_not)
        throw InputError(
            fmt::format("{}: the rig {} cannot do it: {}", options.experiment, rig.name, *drawn.why_not));
    const std::string name = drawn.experiment.kind + "-1";
    return {{planned(options, rig, name, options.out, std::move(drawn.experiment))}, {}};
}

std::vector<PlannedRun> missing_runs(const RecordPlan& plan) {
    std::vector<PlannedRun> missing;
    for (const PlannedRun& run : plan.runs) {
        Recording there;
        there.is_unfinished = true;
        if (const fs::path file = run.folder / "recording.yaml"; fs::exists(file)) {
            read_description(file, there);
            if (there.experiment != run.experiment.kind)
                throw InputError(fmt::format("{}: experiment: {}: is not what is to be recorded, {}",
                                             file.string(), there.experiment, run.experiment.kind));
            const std::string begun = read_origin(file).request_sha256;
            if (!begun.empty() && begun != run.request_sha256)
                throw InputError(
                    fmt::format("{}: request_sha256: the recording was begun with another rig file, "
                                "other commands or another seed; allowed: those, or another --out",
                                file.string()));
        }
        if (there.is_unfinished) missing.push_back(run);
    }
    return missing;
}

double expected_s(const std::vector<PlannedRun>& runs, const Rig& rig) {
    constexpr double homing_speed_mm_per_s = 30.0, registration_and_sweep_s = 9.0, way_s = 1.5;
    double sum_s =
        0.5 * (rig.macro.high_mm - rig.macro.low_mm) / homing_speed_mm_per_s + registration_and_sweep_s;
    bool heated = true;  // by homing
    for (const PlannedRun& run : runs) {
        sum_s += run.experiment.duration_s + way_s + (heated ? cooling_s(rig) : 0.0);
        heated = heats(run.experiment);
    }
    return sum_s;
}

}  // namespace fidservo
