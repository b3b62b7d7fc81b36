// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo export: a recording as a file of MATLAB, HDF5 or CSV.
#include "src/cli/commands.h"
#include "src/import/export_log.h"

#include <map>
#include <memory>
#include <string>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

namespace fidservo {

namespace {

struct ExportOptions {
    std::filesystem::path recording, out;
    imports::ExportFormat format = imports::ExportFormat::mat;
};

}  // namespace

void add_export(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ExportOptions>();
    CLI::App* command = app.add_subcommand("export", "A recording as a MATLAB, HDF5 or CSV file");
    command->add_option("RECORDING", options->recording, "A recording folder")->required();
    command->add_option("--to", options->format, "Format: mat (format 5), hdf5 or csv")
        ->required()
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, imports::ExportFormat>{{"mat", imports::ExportFormat::mat},
                                                         {"hdf5", imports::ExportFormat::hdf5},
                                                         {"csv", imports::ExportFormat::csv}}))
        ->option_text("mat|hdf5|csv");
    command->add_option("--out", options->out, "New file")->required()->type_name("FILE");
    add_example(*command, "fidservo export recordings/rest-1 --to mat --out rest-1.mat");
    command->callback([options, &exit_code] {
        for (const std::string& line :
             imports::export_recording(options->recording, options->format, options->out))
            fmt::print("{}\n", line);
        exit_code = exit_done;
    });
}

}  // namespace fidservo
