// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/manual/command_tree.h"
#include "src/cli/manual/manual.h"

#include <algorithm>
#include <cctype>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

/// Text as roff prints it as it is: no control line, no escape, and hyphens that are typed.
std::string roff(std::string_view text) {
    std::string escaped;
    bool line_begins = true;
    for (const char letter : text) {
        if (line_begins && (letter == '.' || letter == '\'')) escaped += "\\&";
        if (letter == '\\')
            escaped += "\\e";
        else if (letter == '-')
            escaped += "\\-";
        else
            escaped += letter;
        line_begins = letter == '\n';
    }
    return escaped;
}

std::string upper(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char letter) { return std::toupper(letter); });
    return text;
}

std::string page_name(const Command& command) {
    return fmt::format("{}", fmt::join(command.words, "-"));
}

/// A line for man(7)'s NAME begins small, and ends without a full stop.
std::string short_description(const CLI::App& app) {
    std::string text = app.get_description();
    if (text.ends_with('.')) text.pop_back();
    return text;
}

std::string synopsis(const Command& command) {
    const CLI::App& app = *command.app;
    std::string line =
        fmt::format(".B {}\n[OPTIONS]", roff(fmt::format("{}", fmt::join(command.words, " "))));
    const CLI::Formatter formatter;
    for (const CLI::Option* option : app.get_options())
        if (option->get_positional()) line += " " + roff(formatter.make_option_usage(option));
    if (!commands_of(app).empty()) line += app.get_require_subcommand_min() == 0 ? " [COMMAND]" : " COMMAND";
    return line + "\n";
}

std::string option_list(const CLI::App& app, bool positional) {
    std::string text;
    const CLI::Formatter formatter;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional() != positional) continue;
        const std::string name = positional ? formatter.make_option_name(option, true)
                                            : fmt::format("{}", fmt::join(option_words(*option), ", "));
        text += fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff(name), roff(formatter.make_option_opts(option)),
                            roff(formatter.make_option_desc(option)));
    }
    return text;
}

std::string commands_below(const Command& command) {
    std::string text;
    for (const CLI::App* below : commands_of(*command.app))
        text +=
            fmt::format(".TP\n\\fB{}\\fR\n{}. See \\fB{}\\-{}\\fR(1).\n", roff(below->get_name()),
                        roff(short_description(*below)), roff(page_name(command)), roff(below->get_name()));
    return text;
}

std::string section(std::string_view title, const std::string& text) {
    return text.empty() ? "" : fmt::format(".SH {}\n{}", title, text);
}

/// What stands below a command's options: its example.
std::string example_of(const CLI::App& app) {
    constexpr std::string_view label = "Example:\n";
    const std::string footer = app.get_footer();
    if (!footer.starts_with(label)) return {};
    return fmt::format(".nf\n{}\n.fi\n", roff(std::string_view(footer).substr(label.size())));
}

/// The first paragraph below the program's options.
std::string exit_codes(const CLI::App& program) {
    const std::string footer = program.get_footer();
    return roff(std::string_view(footer).substr(0, footer.find("\n\n"))) + "\n";
}

std::string see_also(const std::vector<Command>& all, const Command& command) {
    std::vector<std::string> others;
    for (const Command& other : all)
        if (other.app != command.app &&
            (command.words.size() == 1 || other.words.size() == 1 || other.words[1] == command.words[1]))
            others.push_back(fmt::format("\\fB{}\\fR(1)", roff(page_name(other))));
    return fmt::format("{}\n", fmt::join(others, ",\n"));
}

}  // namespace

std::vector<ManPage> man_pages(const CLI::App& program, std::string_view version) {
    std::vector<ManPage> pages;
    const std::vector<Command> commands = all_commands(program);
    for (const Command& command : commands) {
        const std::string name = page_name(command);
        const CLI::App& app = *command.app;
        pages.push_back(
            {name + ".1",
             fmt::format(".TH {} 1 \"\" \"fidservo {}\" \"fidservo\"\n", roff(upper(name)), roff(version)) +
                 section("NAME", fmt::format("{} \\- {}\n", roff(name), roff(short_description(app)))) +
                 section("SYNOPSIS", synopsis(command)) +
                 section("DESCRIPTION", roff(short_description(app)) + ".\n") +
                 section("COMMANDS", commands_below(command)) + section("ARGUMENTS", option_list(app, true)) +
                 section("OPTIONS", option_list(app, false)) + section("EXAMPLE", example_of(app)) +
                 section("EXIT STATUS", exit_codes(program)) +
                 section("SEE ALSO", see_also(commands, command))});
    }
    return pages;
}

}  // namespace fidservo
