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
    std::vector<std::string> words;  ///< fidservo, calibrate, camera
    const CLI::App* app;
};

/// The program and all that is below it: each command before its own commands.
std::vector<Command> all_commands(const CLI::App& program);

/// The commands that follow a command's words.
std::vector<const CLI::App*> commands_of(const CLI::App& app);

/// As what an option may be given: -h, --help.
std::vector<std::string> option_words(const CLI::Option& option);

}  // namespace fidservo
