// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo simulate: recordings of the simulated rig, with or without effects.
#include "src/simulation/simulate.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_code.h"
#include "src/cli/commands.h"
#include "src/cli/session_options.h"
#include "src/files/recording/utc_time.h"
#include "src/files/recording/writer.h"
#include "src/files/rig/effects_file.h"
#include "src/files/rig/rig_file.h"
#include "src/process/progress.h"
#include "src/simulation/filmed_recording.h"
#include "src/simulation/planned_experiments.h"

#include <memory>
#include <string>
#include <vector>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

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

std::string utc_time_of(const std::string& text) {
    if (is_utc_time(text)) return text;
    throw InputError(fmt::format("--recorded-at: {}: must be a time in UTC like 2026-11-02T08:15:00Z", text));
}

int record_on_simulation(const SimulateOptions& options) {
    const Rig rig = load_rig(options.rig_file);
    if (options.frames && (!rig.camera || !rig.fiducials))
        throw InputError(
            fmt::format("--frames: the rig {} lacks a camera, or fiducials for it to see", rig.name));
    const std::vector<plant::EffectSetting> effects = effects_of(options.effects, options.effects_file);
    const bool is_campaign = options.experiment == whole_campaign;
    const std::vector<PlannedExperiment> plan =
        is_campaign ? planned_campaign(rig, options.seed)
                    : std::vector{planned_experiment(options.experiment, rig, options.seed)};
    plant::PlantParameters parameters = plant::plant_parameters(rig);
    plant::apply_effects(parameters, effects);

    if (is_campaign) make_output_folder(options.out);
    Progress progress("recordings", plan.size());
    for (const auto& [name, experiment] : plan) {
        const std::filesystem::path folder = is_campaign ? options.out / name : options.out;
        if (options.frames)
            write_filmed_recording(folder, rig, effects, experiment, name, options.seed, options.origin);
        else
            write_recording(folder, simulate(rig, effects, experiment, name, options.seed), rig.camera,
                            options.origin);
        progress.advance();
    }
    progress.finish();
    fmt::print("{} recording{} in {}\n", plan.size(), plan.size() == 1 ? "" : "s", options.out.string());
    return exit_done;
}

/// What a formula gives shows while it is simulated, far from where its file was read.
int run_simulate(const SimulateOptions& options) {
    try {
        return record_on_simulation(options);
    } catch (const plant::FormulaFault& fault) {
        fail_at_formula(options.effects_file, fault);
    }
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
