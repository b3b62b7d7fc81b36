#include "src/commands/commands.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "src/config/rig_file.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

namespace fidservo {

void add_rig_option(CLI::App& command, std::filesystem::path& rig_file) {
    rig_file = reference_rig_file();
    command.add_option("--rig", rig_file, "Rig file; the reference rig if not given")->type_name("RIG.yaml");
}

void add_example(CLI::App& command, const std::string& example) {
    command.footer("Example:\n  " + example);
}

void demand_new_file(const char* option, const std::filesystem::path& file) {
    std::error_code error;
    if (!file.empty() &&
        std::filesystem::symlink_status(file, error).type() != std::filesystem::file_type::not_found)
        throw InputError(
            fmt::format("{}: {}: exists already; give the name of a new file", option, file.string()));
}

void make_output_folder(const std::filesystem::path& folder) {
    std::error_code error;
    if (std::filesystem::symlink_status(folder, error).type() != std::filesystem::file_type::not_found)
        throw InputError(
            fmt::format("--out: {}: exists already; give the name of a new folder", folder.string()));
    std::filesystem::create_directories(folder, error);
    if (error)
        throw InputError(fmt::format("--out: {}: cannot be made: {}", folder.string(), error.message()));
}

}  // namespace fidservo
