// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/manual/manual.h"

#include "src/cli/cli.h"
#include "src/cli/manual/command_tree.h"
#include "tests/src/run_program.h"

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fidservo {
namespace {

using ::testing::Contains;
using ::testing::IsSupersetOf;
using ::testing::Not;

struct Manual {
    Manual() : program(make_command_line(exit_code)), pages(man_pages(*program, "1.2.3")) {}
    int exit_code = 0;
    std::unique_ptr<CLI::App> program;
    std::vector<ManPage> pages;
};

/// The options that a text speaks of: -h, --no-diagnosis.
std::set<std::string> options_in(const std::string& text) {
    static const std::regex option("(^|[\\s,])(--?[A-Za-z][A-Za-z-]*)");
    std::set<std::string> found;
    for (auto hit = std::sregex_iterator(text.begin(), text.end(), option); hit != std::sregex_iterator();
         ++hit)
        found.insert((*hit)[2]);
    return found;
}

/// Those that a command's --help lists.
std::set<std::string> options_in_help(const CLI::App& command) {
    static const std::regex line("\n  (-[^ {]*)");
    const std::string help = command.help();
    std::set<std::string> found;
    for (auto hit = std::sregex_iterator(help.begin(), help.end(), line); hit != std::sregex_iterator();
         ++hit)
        found.merge(options_in((*hit)[1]));
    return found;
}

std::string without_roff(std::string text) {
    text = std::regex_replace(text, std::regex("\\\\-"), "-");
    return std::regex_replace(text, std::regex("\\\\f[BR]"), " ");
}

/// What bash offers for the last of the words.
std::set<std::string> completed(const std::string& script_file, const std::vector<std::string>& words) {
    const std::string line = fmt::format(
        "bash -c 'source \"{}\"; COMP_WORDS=({}); COMP_CWORD={}; _fidservo; echo \"${{COMPREPLY[@]}}\"'",
        script_file, fmt::join(words, " "), words.size() - 1);
    const std::unique_ptr<FILE, int (*)(FILE*)> bash(popen(line.c_str(), "r"), pclose);
    std::set<std::string> offered;
    std::array<char, 256> word{};
    while (bash && std::fscanf(bash.get(), "%255s", word.data()) == 1) offered.insert(word.data());
    return offered;
}

TEST(Manual, Pages_HaveEveryOptionOfHelp) {
    const Manual manual;
    const std::vector<Command> commands = all_commands(*manual.program);
    ASSERT_EQ(manual.pages.size(), commands.size());
    for (std::size_t k = 0; k < commands.size(); ++k) {
        const std::set<std::string> wanted = options_in_help(*commands[k].app);
        EXPECT_THAT(wanted, Contains("--help"));
        EXPECT_THAT(options_in(without_roff(manual.pages[k].text)), IsSupersetOf(wanted))
            << manual.pages[k].name;
    }
}

TEST(Manual, Pages_AreNamedForTheirCommands) {
    const Manual manual;
    std::set<std::string> names;
    for (const ManPage& page : manual.pages) names.insert(page.name);
    EXPECT_THAT(names, IsSupersetOf({"fidservo.1", "fidservo-inspect.1", "fidservo-calibrate-camera.1"}));
}

TEST(Manual, Text_BeginsNoLineWithAControlCharacter) {
    CLI::App program(".hidden option\n'quoted", "program");
    const std::string text = man_pages(program, "1").front().text;
    EXPECT_THAT(text, ::testing::HasSubstr("\n\\&.hidden"));
    EXPECT_THAT(text, ::testing::HasSubstr("\n\\&'quoted"));
}

TEST(Manual, Completion_OffersEveryOptionOfHelp) {
    const Manual manual;
    const testing::TemporaryFolder folder;
    const std::string file = folder.path() / "completion";
    std::ofstream(file) << bash_completion(*manual.program);
    for (const Command& command : all_commands(*manual.program)) {
        std::vector<std::string> words = command.words;
        words.emplace_back("--");
        std::set<std::string> wanted = options_in_help(*command.app);
        wanted.erase("-h");
        EXPECT_THAT(completed(file, words), IsSupersetOf(wanted)) << fmt::format("{}", fmt::join(words, " "));
    }
}

TEST(Manual, Completion_OffersCommandsWhereOneIsExpected) {
    const Manual manual;
    const testing::TemporaryFolder folder;
    const std::string file = folder.path() / "completion";
    std::ofstream(file) << bash_completion(*manual.program);
    EXPECT_THAT(completed(file, {"fidservo", "in"}), ::testing::ElementsAre("inspect"));
    EXPECT_THAT(completed(file, {"fidservo", "calibrate", "c"}), ::testing::ElementsAre("camera"));
    EXPECT_THAT(completed(file, {"fidservo", "inspect", "in"}), Not(Contains("inspect")));
}

}  // namespace
}  // namespace fidservo
