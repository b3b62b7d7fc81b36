// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace fidservo {

/// A command, and the words that call it.
struct Command {
    std::vector<std::string> words;  ///< the words by which it is called: fidservo, calibrate, camera
    const CLI::App* app;
};

/// The program and all commands below it, each command before its subcommands.
std::vector<Command> all_commands(const CLI::App& program);

/// The direct subcommands of a command.
std::vector<const CLI::App*> commands_of(const CLI::App& app);

/// The names of an option: -h, --help.
std::vector<std::string> option_words(const CLI::Option& option);

}  // namespace fidservo
