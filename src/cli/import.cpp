// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo import: recordings out of other programs' logs.
#include "core/input_error.h"
#include "src/cli/commands.h"
#include "src/files/rig/plate_file.h"
#include "src/import/assemble.h"
#include "src/import/draft_map.h"
#include "src/import/read_log.h"
#include "src/import/recording_folder.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace fidservo {

namespace {

struct ImportOptions {
    std::vector<std::filesystem::path> files;
    std::filesystem::path map_file, out;
};

/// The map that a file carries because fidservo export wrote it.
std::optional<imports::ImportMap> carried_map(const std::vector<imports::Log>& logs) {
    for (const imports::Log& log : logs) {
        const auto text = log.texts.find(imports::map_text);
        if (text == log.texts.end()) continue;
        imports::ImportMap map = imports::parse_import_map(text->second, log.file);
        if (const auto plate = log.texts.find(imports::plate_text); plate != log.texts.end())
            map.stated.plate = read_plate(YamlValue::parse(plate->second, log.file)).tags;
        return map;
    }
    return std::nullopt;
}

int run_import(const ImportOptions& options) {
    std::optional<imports::ImportMap> map;
    if (!options.map_file.empty()) map = imports::load_import_map(options.map_file);
    const TableOptions table = map ? map->table : TableOptions{.are_offered = false};
    const std::vector<imports::Log> logs = imports::read_logs(options.files, table);
    if (!map) map = carried_map(logs);
    if (!map) {
        fmt::print("{}", imports::draft_map(logs));
        spdlog::info("without a map nothing is written: edit the lines above and give them by --map");
        return exit_done;
    }
    if (options.out.empty()) throw InputError("--out: missing: the new folder for the recording");
    for (const imports::Log& log : logs)
        for (const std::string& note : log.notes) spdlog::info("{}: {}", log.file.string(), note);
    const imports::Assembled made = imports::assemble(logs, *map);
    imports::write_folder(options.out, made);
    for (const std::string& note : made.notes) fmt::print("{}\n", note);
    fmt::print("recording: {}\n", options.out.string());
    return exit_done;
}

}  // namespace

void add_import(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ImportOptions>();
    CLI::App* command =
        app.add_subcommand("import", "A recording out of MATLAB, HDF5, ROS 2, EuRoC or CSV files");
    command
        ->add_option("FILE", options->files,
                     "Logs of one run: .mat, HDF5, rosbag2 (.db3 or its folder), a folder as EuRoC's, CSV")
        ->required()
        ->option_text("...");
    command
        ->add_option("--map", options->map_file,
                     "Which signal is what (docs/import.md); without it, what was found and a map to edit")
        ->type_name("MAP.yaml");
    command->add_option("--out", options->out, "New folder for the recording")->type_name("DIR");
    add_example(*command,
                "fidservo import log.mat > map.yaml\n  fidservo import log.mat --map map.yaml --out run-1");
    command->callback([options, &exit_code] { exit_code = run_import(*options); });
}

}  // namespace fidservo
