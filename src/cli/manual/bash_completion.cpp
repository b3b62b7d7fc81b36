// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/manual/command_tree.h"
#include "src/cli/manual/manual.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

std::vector<std::string> options_of(const CLI::App& app) {
    std::vector<std::string> words;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& word : option_words(*option)) words.push_back(word);
    return words;
}

std::vector<std::string> command_words(const CLI::App& app) {
    std::vector<std::string> words;
    for (const CLI::App* command : commands_of(app)) words.push_back(command->get_name());
    return words;
}

/// A branch of the script's case: what may follow the words of a command.
std::string branch(const Command& command) {
    return fmt::format("        '{}') commands='{}' options='{}' ;;\n", fmt::join(command.words, " "),
                       fmt::join(command_words(*command.app), " "), fmt::join(options_of(*command.app), " "));
}

}  // namespace

std::string bash_completion(const CLI::App& program) {
    std::string words_that_call;
    std::string branches;
    for (const Command& command : all_commands(program)) {
        words_that_call += fmt::format("        '{}'\n", fmt::join(command.words, " "));
        branches += branch(command);
    }
    return fmt::format(R"(# Completion of fidservo's commands and options, for bash.
_fidservo() {{
    local called=(
{}    )
    local current=${{COMP_WORDS[COMP_CWORD]}} chosen=fidservo commands='' options='' word known
    for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
        for known in "${{called[@]}}"; do
            if [[ $known == "$chosen $word" ]]; then
                chosen=$known
                break
            fi
        done
    done
    case $chosen in
{}    esac
    if [[ $current == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
    elif [[ -n $commands ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$current")
    fi
}}
complete -o default -F _fidservo fidservo
)",
                       words_that_call, branches);
}

}  // namespace fidservo
