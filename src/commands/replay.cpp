// fidservo replay: the analysis of a run on images that exist already.
#include "src/replay/replay.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "src/commands/commands.h"
#include "src/config/rig_file.h"

#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

namespace fidservo {

namespace {

struct ReplayOptions {
    std::vector<std::filesystem::path> inputs;
    std::filesystem::path rig_file;
    bool rig_is_given = false;
    std::filesystem::path out = "replay-out";
};

int run_replay(const ReplayOptions& options) {
    const Rig rig = load_rig(options.rig_file);
    if (!rig.fiducials)
        throw InputError(fmt::format("{}: fiducials: missing: their side_mm is the scale of displacements",
                                     options.rig_file.string()));
    ReplayFrames frames(options.inputs);
    make_output_folder(options.out);
    try {
        const ReplayCount count = replay(frames, rig.fiducials->side_mm, options.out,
                                         std::max(1u, std::thread::hardware_concurrency()),
                                         options.rig_is_given ? rig.camera : std::nullopt);
        fmt::print("{} tags in {} images: {}, {}\n", count.tags, count.images,
                   (options.out / "detections.csv").string(), (options.out / "displacements.csv").string());
    } catch (const InputError&) {
        std::filesystem::remove_all(options.out);
        throw;
    }
    return exit_done;
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ReplayOptions>();
    CLI::App* command = app.add_subcommand(
        "replay",
        "Find the fiducials in images that exist; writes detections.csv (px) and displacements.csv (um)");
    command
        ->add_option("INPUT", options->inputs,
                     "Recording folders (EuRoC layout), image folders, videos, images")
        ->required()
        ->option_text("...");
    add_rig_option(*command, options->rig_file);
    command->add_option("--out", options->out, "New folder for the results")
        ->type_name("DIR")
        ->capture_default_str();
    add_example(*command, "fidservo replay photos/ --out photos-tags");
    command->callback([options, command, &exit_code] {
        options->rig_is_given = command->count("--rig") > 0;
        exit_code = run_replay(*options);
    });
}

}  // namespace fidservo
