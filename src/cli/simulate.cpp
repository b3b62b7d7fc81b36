// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo simulate: recordings of the simulated rig, with or without effects.
#include "src/simulation/simulate.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "src/cli/commands.h"
#include "src/cli/session_options.h"
#include "src/files/recording/utc_time.h"
#include "src/files/recording/writer.h"
#include "src/files/rig/effects_file.h"
#include "src/files/rig/rig_file.h"
#include "src/process/progress.h"
#include "src/simulation/experiment_file.h"
#include "src/simulation/filmed_recording.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

constexpr const char* whole_campaign = "campaign";

struct SimulateOptions {
    std::string experiment;
    std::filesystem::path rig_file;
    std::vector<std::string> effects;
    std::filesystem::path effects_file;
    std::uint64_t seed = 1;
    RecordingOrigin origin;
    bool frames = false;
    std::filesystem::path out;
};

/// One recording of a run.
struct Task {
    Experiment experiment;
    std::string name;
    std::filesystem::path folder;
};

Task task_of(const SimulateOptions& options, const Rig& rig) {
    if (is_experiment_file(options.experiment)) {
        Experiment experiment = load_experiment(options.experiment, rig);
        std::string name = experiment.kind + "-1";
        return {std::move(experiment), std::move(name), options.out};
    }
    const std::string name = options.experiment + "-1";
    return {make_experiment(options.experiment, rig, options.seed, name), name, options.out};
}

std::vector<Task> tasks_of(const SimulateOptions& options, const Rig& rig) {
    if (options.experiment != whole_campaign) return {task_of(options, rig)};
    std::vector<Task> tasks;
    for (const CampaignRun& run : campaign_runs(rig))
        tasks.push_back(
            {make_experiment(run.kind, rig, options.seed, run.name), run.name, options.out / run.name});
    return tasks;
}

/// Where no effect of the effects file is named, all of them act, at their typical values.
std::vector<plant::EffectSetting> effects_of(const SimulateOptions& options) {
    std::vector<const plant::Effect*> formulas;
    if (!options.effects_file.empty()) formulas = load_effects_file(options.effects_file);
    std::vector<plant::EffectSetting> effects;
    for (const std::string& text : options.effects) effects.push_back(plant::parse_effect(text, formulas));
    const auto is_named = [&](const plant::Effect* formula) {
        return std::ranges::find(effects, formula, &plant::EffectSetting::effect) != effects.end();
    };
    if (std::ranges::none_of(formulas, is_named))
        for (const plant::Effect* formula : formulas) effects.push_back(plant::typical_setting(*formula));
    return effects;
}

std::string utc_time_of(const std::string& text) {
    if (is_utc_time(text)) return text;
    throw InputError(fmt::format("--recorded-at: {}: must be a time in UTC like 2026-11-02T08:15:00Z", text));
}

int run_simulate(const SimulateOptions& options) {
    const Rig rig = load_rig(options.rig_file);
    if (options.frames && (!rig.camera || !rig.fiducials))
        throw InputError(
            fmt::format("--frames: the rig {} lacks a camera, or fiducials for it to see", rig.name));
    const std::vector<plant::EffectSetting> effects = effects_of(options);
    const std::vector<Task> tasks = tasks_of(options, rig);
    plant::PlantParameters parameters = plant::plant_parameters(rig);
    plant::apply_effects(parameters, effects);

    if (options.experiment == whole_campaign) make_output_folder(options.out);
    Progress progress("recordings", tasks.size());
    for (const Task& task : tasks) {
        if (options.frames)
            write_filmed_recording(task.folder, rig, effects, task.experiment, task.name, options.seed,
                                   options.origin);
        else
            write_recording(task.folder, simulate(rig, effects, task.experiment, task.name, options.seed),
                            rig.camera, options.origin);
        progress.advance();
    }
    progress.finish();
    fmt::print("{} recording{} in {}\n", tasks.size(), tasks.size() == 1 ? "" : "s", options.out.string());
    return exit_done;
}

}  // namespace

void add_simulate(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<SimulateOptions>();
    CLI::App* command = app.add_subcommand("simulate", "Record experiments on the simulated rig");
    command
        ->add_option("EXPERIMENT", options->experiment,
                     fmt::format("{}; campaign: two of each that the rig can do; or FILE.yaml, an experiment "
                                 "of one's own (docs/formats.md)",
                                 fmt::join(experiment_kinds(), ", ")))
        ->required()
        ->option_text(" ");
    add_rig_option(*command, options->rig_file);
    command
        ->add_option(
            "--effect", options->effects,
            "What the rig has and its file does not state: NAME or NAME:PARAMETER=VALUE,...; may be repeated")
        ->type_name("EFFECT")
        ->expected(1)
        ->take_all();
    command
        ->add_option(
            "--effects-file", options->effects_file,
            "Effects as formulas (docs/effects.md), known to --effect by name; where it names none of "
            "them, all act at their typical values")
        ->type_name("FILE");
    command->add_flag("--frames", options->frames,
                      "Render and keep the camera's frames; detections are what is found in them");
    command->add_option("--seed", options->seed, "Determines excitation and noise; same seed, same bytes")
        ->capture_default_str();
    add_origin_options(*command, options->origin);
    command
        ->add_option_function<std::string>(
            "--recorded-at",
            [options](const std::string& time) { options->origin.recorded_at = utc_time_of(time); },
            "When the recordings are said to be made, in UTC: 2026-11-02T08:15:00Z; else they say nothing of "
            "it")
        ->type_name("TIME");
    command->add_option("--out", options->out, "New folder for the recordings")->type_name("DIR")->required();
    add_example(
        *command,
        "fidservo simulate campaign --effect ambient_temperature:shift_degC=8 --seed 7 --out warm-room");
    command->callback([options, &exit_code] { exit_code = run_simulate(*options); });
}

}  // namespace fidservo
