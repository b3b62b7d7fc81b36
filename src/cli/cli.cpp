// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/cli.h"

#include "core/input_error.h"
#include "src/cli/commands.h"
#include "src/files/text/key_names.h"
#include "src/process/commit.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/core/utility.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace fidservo {

namespace {

constexpr std::array add_commands{add_inspect,  add_goto,     add_home,      add_replay,   add_record,
                                  add_simulate, add_identify, add_calibrate, add_diagnose, add_reproduce,
                                  add_cameras,  add_rig,      add_import,    add_export,   add_fleet};

int complain(int exit_code, std::string message) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    std::fflush(stdout);
    std::fputs(fmt::format("fidservo: {}\n", message).c_str(), stderr);
    return exit_code;
}

std::vector<std::string> names_of(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
    return names;
}

/// CLI11 reports an unknown command as a stray argument; people are better served with the commands there
/// are.
void demand_known_command(const CLI::App& app, int argc, const char* const* argv) {
    const std::vector<std::string> names = names_of(app);
    const std::string list = fmt::format("commands: {}", fmt::join(names, ", "));
    if (argc < 2) throw InputError(fmt::format("a command is needed; {}", list));
    const std::string_view word = argv[1];
    if (word.starts_with('-') || std::find(names.begin(), names.end(), word) != names.end()) return;
    const std::string_view meant = nearest_word(word, {names.begin(), names.end()});
    throw InputError(fmt::format("{}: unknown command{}; {}", word,
                                 meant.empty() ? "" : fmt::format(", did you mean {}?", meant), list));
}

std::string help_for(const CLI::App& app) {
    const auto chosen = app.get_subcommands();
    return chosen.empty() ? "fidservo --help" : fmt::format("fidservo {} --help", chosen.front()->get_name());
}

int parse_and_run(CLI::App& app, int& exit_code, int argc, const char* const* argv) {
    try {
        demand_known_command(app, argc, argv);
        app.parse(argc, argv);
        return exit_code;
    } catch (const CLI::Success& help_or_version) {
        return app.exit(help_or_version);
    } catch (const CLI::ParseError& error) {
        return complain(exit_wrong_input, fmt::format("{} (see {})", error.what(), help_for(app)));
    }
}

/// The user gets one line from this program, not the libraries' own.
void silence_libraries() {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    cv::redirectError([](int, const char*, const char*, const char*, int, void*) { return 0; });
}

/// Notes go to stderr: stdout is for results, which scripts read.
void log_to_stderr() {
    const auto logger = spdlog::stderr_logger_st("fidservo");
    logger->set_pattern("fidservo: %v");
    spdlog::set_default_logger(logger);
}

}  // namespace

std::unique_ptr<CLI::App> make_command_line(int& exit_code) {
    auto app = std::make_unique<CLI::App>(
        "Visual inspection on a macro-micro positioning stage, on the rig or on its simulation.", "fidservo");
    app->set_version_flag("--version", std::string("fidservo ") + program_version());
    app->require_subcommand(1);
    app->footer(
        "Exit codes: 0 done; 1 done, but the answer is no (a failed inspection, a target not reached);\n"
        "2 wrong input; 3 a device or run fault.\n\n"
        "fidservo COMMAND --help shows a command's options, their units and an example.");
    for (const auto& add_command : add_commands) add_command(*app, exit_code);
    return app;
}

int run_command_line(int argc, const char* const* argv) {
    silence_libraries();
    log_to_stderr();
    int exit_code = exit_done;
    const std::unique_ptr<CLI::App> app = make_command_line(exit_code);
    try {
        return parse_and_run(*app, exit_code, argc, argv);
    } catch (const InputError& error) {
        return complain(exit_wrong_input, error.what());
    } catch (const RunFault& fault) {
        return complain(exit_fault, fault.what());
    } catch (const std::exception& error) {
        return complain(exit_fault, error.what());
    }
}

}  // namespace fidservo
