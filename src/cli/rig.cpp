// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo rig: a rig file to start from, and what is to be said of one.
#include "core/rig.h"

#include "core/input_error.h"
#include "src/cli/commands.h"
#include "src/files/disk/durable_file.h"
#include "src/files/rig/fod_file.h"
#include "src/files/rig/rig_file.h"
#include "src/files/rig/stage_keys.h"
#include "src/rig/check_output.h"
#include "src/rig/draft.h"
#include "src/rig/generic_fod.h"
#include "src/rig/questions.h"

#include <iostream>
#include <map>
#include <memory>
#include <string>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>
#include <unistd.h>

namespace fidservo {

namespace {

struct NewOptions {
    RigDraft draft;
    std::filesystem::path out;
    std::filesystem::path fod;
};

struct CheckOptions {
    std::filesystem::path rig_file;
    std::filesystem::path json;
};

/// As YAML writes a word that may hold anything.
std::string quoted(const std::string& word) {
    std::string text = "'";
    for (const char letter : word) text += letter == '\'' ? std::string("''") : std::string(1, letter);
    return text + "'";
}

/// What the rig file names as its table; one that nobody gave is written beside it.
std::string place_fod(const NewOptions& options) {
    if (!options.fod.empty())
        return std::filesystem::proximate(std::filesystem::absolute(options.fod),
                                          std::filesystem::absolute(options.out).parent_path())
            .string();
    std::filesystem::path file = options.out;
    file.replace_filename(options.out.stem().string() + "_fod.csv");
    demand_new_file("--out", file);
    const RigDraft& draft = options.draft;
    write_or_throw(file, fod_text(generic_fod(draft.micro_travel_mm[1] - draft.micro_travel_mm[0])));
    return file.filename().string();
}

int run_new(NewOptions& options, const CLI::App& command) {
    demand_new_file("--out", options.out);
    if (::isatty(STDIN_FILENO) == 1)
        ask(
            options.draft, [&](std::string_view option) { return command.count(std::string(option)) > 0; },
            std::cin, std::cerr);
    demand_sound(options.draft);
    if (!options.fod.empty()) (void)load_fod(options.fod);
    const std::string fod = options.draft.has_micro() ? quoted(place_fod(options)) : "";
    write_or_throw(options.out, rig_text(options.draft, fod));
    (void)load_rig(options.out);
    fmt::print("rig file: {}\n", options.out.string());
    return exit_done;
}

int run_check(const CheckOptions& options) {
    demand_new_file("--json", options.json);
    const Rig rig = load_rig(options.rig_file);
    const std::vector<Ability> abilities =
        abilities_of(rig, load_stage_keys(options.rig_file).comedi.has_value());
    const std::vector<Finding> findings = findings_of(rig);
    fmt::print("{}", describe(abilities, findings));
    if (!options.json.empty()) write_rig_check_json(options.json, rig.name, abilities, findings);
    return findings.empty() ? exit_done : exit_answer_is_no;
}

void add_axis_options(CLI::App& command, RigDraft& draft) {
    command.add_option("--name", draft.name, "Of the rig")->capture_default_str();
    command.add_option("--tick-s", draft.tick_s, "Of the control loop")
        ->check(CLI::Range(1e-6, 1.0))
        ->capture_default_str();
    command.add_option("--travel-mm", draft.travel_mm, "LOW,HIGH of the axis [0,200]")
        ->delimiter(',')
        ->option_text("LOW,HIGH");
    command.add_option("--resolution-mm", draft.resolution_mm, "A count of the encoder")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command.add_option("--command-limit-V", draft.command_limit_V, "Largest command of the motor")
        ->check(CLI::Range(1e-6, 100.0))
        ->capture_default_str();
    command
        .add_option(
            "--friction-V", draft.friction_V,
            "A command that surely moves the axis, and little more; a fifth of the limit if not given")
        ->check(CLI::Range(1e-6, 100.0));
}

void add_micro_options(CLI::App& command, NewOptions& options) {
    RigDraft& draft = options.draft;
    command.add_option("--micro-travel-mm", draft.micro_travel_mm, "LOW,HIGH of the micro stage [0,4]")
        ->delimiter(',')
        ->option_text("LOW,HIGH");
    command.add_option("--heater-onset-V", draft.heater_onset_V, "Command at which its wire begins to heat")
        ->check(CLI::Range(0.0, 100.0))
        ->capture_default_str();
    command.add_option("--heater-limit-V", draft.heater_limit_V, "Largest command that its wire bears")
        ->check(CLI::Range(1e-6, 100.0))
        ->capture_default_str();
    command.add_option("--adc-bits", draft.adc_bits, "Of the Hall sensor's converter")
        ->check(CLI::Range(1, 24))
        ->capture_default_str();
    command.add_option("--adc-range-V", draft.adc_range_V, "Likewise")
        ->check(CLI::Range(1e-6, 100.0))
        ->capture_default_str();
    command
        .add_option(
            "--fod", options.fod,
            "The wire's table of first-order descending curves; a generic one is written if not given")
        ->type_name("FILE");
}

void add_camera_options(CLI::App& command, RigDraft& draft) {
    command.add_option("--image-px", draft.image_px, "WIDTH,HEIGHT of the image [1280,960]")
        ->delimiter(',')
        ->check(CLI::Range(16, 20'000))
        ->option_text("WIDTH,HEIGHT");
    command.add_option("--focal-px", draft.focal_px, "Focal length / size of a pixel")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command.add_option("--distance-mm", draft.distance_mm, "From the lens to the plate")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command.add_option("--frame-rate-hz", draft.frame_rate_hz, "Of the camera")
        ->check(CLI::Range(1e-3, 1e5))
        ->capture_default_str();
    command.add_option("--tag-side-mm", draft.tag_side_mm, "Of a tag's black border")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command.add_option("--pitch-mm", draft.pitch_mm, "From tag to tag")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command
        .add_option("--columns", draft.columns,
                    "Tags along the axis; as many as the travel needs if not given")
        ->check(CLI::Range(1, 587));
    command.add_option("--rows", draft.rows, "Tags across it")
        ->check(CLI::Range(1, 587))
        ->capture_default_str();
    command.add_option("--first-id", draft.first_id, "Of the tag at plate x 0")
        ->check(CLI::Range(0, 586))
        ->capture_default_str();
}

void add_new(CLI::App& parent, int& exit_code) {
    auto options = std::make_shared<NewOptions>();
    CLI::App* command = parent.add_subcommand(
        "new", "Write a commented rig file to start from; on a terminal it asks for what is not given");
    command->add_option("--out", options->out, "New rig file")->type_name("RIG.yaml")->required();
    command
        ->add_option("--kind", options->draft.kind,
                     "axis, camera (an axis, a camera and fiducials) or full (a micro stage too) [full]")
        ->transform(CLI::CheckedTransformer(std::map<std::string, RigKind>{
            {"axis", RigKind::axis}, {"camera", RigKind::camera}, {"full", RigKind::full}}))
        ->option_text("KIND");
    add_axis_options(*command, options->draft);
    add_micro_options(*command, *options);
    add_camera_options(*command, options->draft);
    add_example(
        *command,
        "fidservo rig new --travel-mm 0,300 --resolution-mm 0.01 --command-limit-V 10 --out my-rig.yaml");
    command->callback([options, command, &exit_code] { exit_code = run_new(*options, *command); });
}

void add_check(CLI::App& parent, int& exit_code) {
    auto options = std::make_shared<CheckOptions>();
    CLI::App* command =
        parent.add_subcommand("check",
                              "What each command can do with a rig file, and what looks wrong "
                              "in it; exit code 1 if anything does");
    command->add_option("RIG.yaml", options->rig_file, "Rig file")->required()->option_text(" ");
    command->add_option("--json", options->json, "New file for the same")->type_name("FILE");
    add_example(*command, "fidservo rig check my-rig.yaml");
    command->callback([options, &exit_code] { exit_code = run_check(*options); });
}

}  // namespace

void add_rig(CLI::App& app, int& exit_code) {
    CLI::App* group = app.add_subcommand("rig", "A rig file to start from; a check of one");
    group->require_subcommand(0, 1);
    add_new(*group, exit_code);
    add_check(*group, exit_code);
    group->callback([group] {
        if (group->get_subcommands().empty()) throw InputError("rig: what? One of: new, check");
    });
}

}  // namespace fidservo
