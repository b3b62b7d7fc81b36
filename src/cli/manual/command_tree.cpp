// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/manual/command_tree.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace fidservo {

namespace {

void append_commands(std::vector<Command>& commands, std::vector<std::string> words, const CLI::App& app) {
    words.push_back(app.get_name());
    commands.push_back({words, &app});
    for (const CLI::App* command : commands_of(app)) append_commands(commands, words, *command);
}

}  // namespace

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App* command) { return !command->get_name().empty(); });
}

std::vector<Command> all_commands(const CLI::App& program) {
    std::vector<Command> commands;
    append_commands(commands, {}, program);
    return commands;
}

std::vector<std::string> option_words(const CLI::Option& option) {
    std::vector<std::string> words;
    for (const std::string& name : option.get_snames()) words.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) words.push_back("--" + name);
    return words;
}

}  // namespace fidservo
