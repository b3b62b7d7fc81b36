// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/house/house_rules.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string_view>

namespace fidservo::house {

namespace {

using Rooms = std::set<std::string>;

constexpr std::size_t longest_file_lines = 400;
constexpr std::string_view licence = "// SPDX-License-Identifier: GPL-3.0-or-later\n";

/// What each room may include besides itself.
const std::map<std::string, Rooms>& arrows() {
    static const std::map<std::string, Rooms> allowed{
        {"core", {}},
        {"vision", {"core"}},
        {"control", {"core"}},
        {"plant", {"core"}},
        {"reference", {"core"}},
        {"calib", {"core", "vision"}},
        {"gap", {"core", "plant", "calib", "control"}},
        {"src", {"core", "vision", "control", "calib", "plant", "gap", "reference"}},
        {"python", {"core", "vision", "control", "calib", "plant", "gap", "reference", "src"}},
    };
    return allowed;
}

/// The rooms of the diagnosis, each of which may include those before it. What lies in gap/ itself is their
/// door: the types that all of them speak of, and the diagnosis that calls them.
const std::vector<std::string>& rooms_of_gap() {
    static const std::vector<std::string> order{
        "gap/evidence", "gap/links",  "gap/candidates", "gap/fit",     "gap/balance",
        "gap/starts",   "gap/search", "gap/residuals",  "gap/verdict", "gap/equation"};
    return order;
}

std::string room_of(const std::string& path) {
    return path.substr(0, path.find('/'));
}

/// The part of the program that a file of src belongs to.
std::string part_of_src(const std::string& path) {
    static const std::regex pattern("src/files/[^/]+/|src/[^/]+/");
    std::smatch found;
    return std::regex_search(path, found, pattern, std::regex_constants::match_continuous) ? found.str()
                                                                                           : "src/";
}

std::string finding(const SourceFile& file, const std::string& what, const std::string& why) {
    return file.path + ": " + what + ": " + why;
}

std::string folder_of(const std::string& path) {
    return std::filesystem::path(path).parent_path().string();
}

bool is_header(const std::string& path) {
    return path.ends_with(".h");
}

std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
    std::vector<std::string> found;
    for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match) {
        found.push_back((*match)[1]);
    }
    return found;
}

/// The same, where a text has one of the words without which the pattern is nowhere: to look for these takes
/// a hundredth.
std::vector<std::string> matches(const std::string& text, const std::regex& pattern,
                                 std::initializer_list<std::string_view> words) {
    const bool has_any = std::any_of(words.begin(), words.end(), [&](std::string_view word) {
        return text.find(word) != std::string::npos;
    });
    return has_any ? matches(text, pattern) : std::vector<std::string>{};
}

/// What is between the brackets of lines that include.
std::vector<std::string> includes(const std::string& text, char open, char close) {
    constexpr std::string_view word = "#include ";
    std::vector<std::string> found;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        const std::size_t before = text.find_last_not_of(" \t", at - 1), name = at + word.size();
        const bool begins_a_line = at == 0 || before == std::string::npos || text[before] == '\n';
        if (!begins_a_line || text[name] != open) continue;
        const std::size_t end = text.find(close, name + 1);
        if (end != std::string::npos) found.push_back(text.substr(name + 1, end - name - 1));
    }
    return found;
}

std::vector<std::string> quoted_includes(const std::string& text) {
    return includes(text, '"', '"');
}

std::vector<std::string> angle_includes(const std::string& text) {
    return includes(text, '<', '>');
}

/// Neither the standard library nor the system, nor one of the libraries that may be seen everywhere.
bool is_hidden_library(const std::string& header) {
    constexpr std::string_view shown[] = {"Eigen/", "opencv2/core", "tl/expected.hpp", "sys/", "linux/"};
    const bool plain = header.find('/') == std::string::npos;
    return !plain && std::none_of(std::begin(shown), std::end(shown),
                                  [&](std::string_view name) { return header.starts_with(name); });
}

bool has_file(const std::vector<SourceFile>& house, const std::string& path) {
    return std::any_of(house.begin(), house.end(), [&](const SourceFile& file) { return file.path == path; });
}

SourceFile read(const std::filesystem::path& file, const std::string& top) {
    std::ifstream in(file);
    return {std::filesystem::relative(file, top).string(), {std::istreambuf_iterator<char>(in), {}}};
}

}  // namespace

std::vector<SourceFile> read_house(const std::string& top) {
    std::vector<SourceFile> house;
    Rooms folders{"tests", "bench"};
    for (const auto& [room, allowed] : arrows()) folders.insert(room);
    for (const auto& folder : folders) {
        const auto root = std::filesystem::path(top) / folder;
        if (!std::filesystem::is_directory(root)) continue;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
            const auto extension = entry.path().extension();
            if (extension != ".h" && extension != ".cpp") continue;
            house.push_back(read(entry.path(), top));
        }
    }
    return house;
}

std::vector<SourceFile> read_documents(const std::string& top) {
    std::vector<SourceFile> documents;
    for (const char* folder : {".", "docs"})
        for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(top) / folder))
            if (entry.path().extension() == ".md") documents.push_back(read(entry.path(), top));
    return documents;
}

Findings forbidden_arrows(const SourceFile& file) {
    Findings findings;
    const std::string room = room_of(file.path);
    const auto allowed = arrows().find(room);
    if (allowed == arrows().end()) return findings;  // tests and benchmarks see all rooms
    for (const auto& include : quoted_includes(file.text)) {
        const std::string seen = room_of(include);
        if (seen == room || allowed->second.contains(seen)) continue;
        findings.push_back(finding(file, "includes " + include, "which " + room + " must not see"));
    }
    return findings;
}

Findings steps_up_in_gap(const SourceFile& file) {
    const auto place_of = [](const std::string& path) {
        return std::ranges::find(rooms_of_gap(), folder_of(path)) - rooms_of_gap().begin();
    };
    const std::string own = folder_of(file.path);
    if (!own.starts_with("gap/")) return {};
    if (std::ranges::find(rooms_of_gap(), own) == rooms_of_gap().end())
        return {finding(file, own, "no room of the diagnosis that has a place among the others")};
    Findings findings;
    for (const auto& include : quoted_includes(file.text))
        if (folder_of(include).starts_with("gap/") && place_of(include) > place_of(file.path))
            findings.push_back(finding(file, "includes " + include, "which " + own + " must not see"));
    return findings;
}

Findings circles_in_src(const std::vector<SourceFile>& house) {
    Findings findings;
    std::map<std::string, std::set<std::string>> seen_by;
    for (const SourceFile& file : house) {
        if (room_of(file.path) != "src") continue;
        const std::string part = part_of_src(file.path);
        seen_by[part];
        for (const std::string& include : quoted_includes(file.text)) {
            const std::string other = part_of_src(include);
            if (room_of(include) != "src" || other == part) continue;
            seen_by[part].insert(other);
            if (other == "src/cli/") findings.push_back(finding(file, include, "is above it"));
        }
    }
    const auto is_at_an_end = [&](const auto& part) {
        const bool sees_some =
            std::any_of(part.second.begin(), part.second.end(),
                        [&](const std::string& other) { return seen_by.count(other) > 0; });
        const bool is_seen = std::any_of(seen_by.begin(), seen_by.end(), [&](const auto& other) {
            return other.second.count(part.first) > 0;
        });
        return !sees_some || !is_seen;
    };
    for (;;) {
        const auto end = std::find_if(seen_by.begin(), seen_by.end(), is_at_an_end);
        if (end == seen_by.end()) break;
        seen_by.erase(end);
    }
    for (const auto& [part, others] : seen_by) findings.push_back(part + ": in a circle of folders");
    return findings;
}

Findings includes_not_from_the_top(const SourceFile& file, const std::vector<SourceFile>& house) {
    Findings findings;
    for (const auto& include : quoted_includes(file.text)) {
        if (!has_file(house, include))
            findings.push_back(file.path + ": no such file from the top: " + include);
    }
    return findings;
}

Findings leaking_third_party(const SourceFile& file, const std::vector<SourceFile>& house) {
    Findings findings;
    if (!is_header(file.path)) return findings;
    for (const auto& include : angle_includes(file.text)) {
        if (!is_hidden_library(include)) continue;
        for (const auto& other : house) {
            if (other.text.find(file.path) == std::string::npos) continue;
            const auto seen = quoted_includes(other.text);
            const bool inside = folder_of(other.path) == folder_of(file.path) ||
                                other.path.starts_with("tests/") ||
                                (room_of(file.path) == "src" &&
                                 (room_of(other.path) == "src" || room_of(other.path) == "python"));
            if (inside || std::find(seen.begin(), seen.end(), file.path) == seen.end()) continue;
            findings.push_back(file.path + ": shows <" + include + "> to " + other.path);
        }
    }
    return findings;
}

Findings wrong_namespace(const SourceFile& file) {
    const std::string room = room_of(file.path);
    if (!arrows().contains(room) || file.path == "src/cli/main.cpp") return {};
    const bool plain = room == "core" || room == "src";
    const std::string expected = plain ? "namespace fidservo" : "namespace fidservo::" + room;
    if (file.text.find(expected) != std::string::npos) return {};
    return {file.path + ": not in " + expected};
}

Findings unguarded_header(const SourceFile& file) {
    if (!is_header(file.path) || file.text.find("\n#pragma once\n") == licence.size() - 1) return {};
    return {file.path + ": does not begin with #pragma once"};
}

Findings unlicensed(const SourceFile& file) {
    if (file.text.starts_with(licence)) return {};
    return {file.path + ": does not begin with its SPDX line"};
}

Findings too_long(const SourceFile& file) {
    const auto lines = static_cast<std::size_t>(std::count(file.text.begin(), file.text.end(), '\n'));
    if (lines <= longest_file_lines) return {};
    return {file.path + ": " + std::to_string(lines) + " lines; at most " +
            std::to_string(longest_file_lines)};
}

Findings machine_paths(const SourceFile& file) {
    static const std::regex pattern(R"re((/(?:home|root|work|Users|usr/local)/[^"\s]*))re");
    Findings findings;
    for (const auto& path : matches(file.text, pattern))
        findings.push_back(file.path + ": machine path " + path);
    return findings;
}

Findings wall_clocks(const SourceFile& file) {
    static const std::regex pattern(R"re((system_clock|CLOCK_REALTIME|gettimeofday|\btime\())re");
    if (!arrows().contains(room_of(file.path)) || file.path == "control/guardian_process.cpp" ||
        file.path == "src/files/recording/utc_time.cpp")
        return {};
    Findings findings;
    for (const auto& clock :
         matches(file.text, pattern, {"system_clock", "CLOCK_REALTIME", "gettimeofday", "time("}))
        findings.push_back(file.path + ": wall clock " + clock);
    return findings;
}

Findings tests_that_are_not_there(const SourceFile& document, const std::vector<SourceFile>& house) {
    static const std::regex pattern(R"re(`([A-Z]\w*\.[A-Z]\w*_\w+)`)re");
    Findings findings;
    for (std::string name : matches(document.text, pattern)) {
        const std::string head = "(" + name.replace(name.find('.'), 1, ", ") + ")";
        const bool is_there = std::any_of(house.begin(), house.end(), [&](const SourceFile& file) {
            return file.path.starts_with("tests/") && file.text.find(head) != std::string::npos;
        });
        if (!is_there) findings.push_back(document.path + ": no test " + head);
    }
    return findings;
}

Findings effects_asked_for(const SourceFile& file, const std::vector<SourceFile>& house) {
    if (!file.path.starts_with("gap/") || file.path == "gap/residuals/accusation.cpp") return {};
    static const std::regex literal(R"re("([a-z_.]+)")re"), name(R"re(\.name = "([a-z_]+)")re"),
        block(R"re((?:macro|micro|camera)\.[a-z]*)re"), unit(R"re(((?:\.|->|::)unit (?:==|!=)))re");
    std::set<std::string> effects;
    for (const SourceFile& other : house)
        if (other.path.starts_with("plant/effects/"))
            for (const std::string& effect : matches(other.text, name)) effects.insert(effect);
    Findings findings;
    for (const std::string& text : matches(file.text, literal))
        if (effects.contains(text) || std::regex_match(text, block))
            findings.push_back(finding(file, text, "an effect says what it does in its own file"));
    for (const std::string& text : matches(file.text, unit))
        findings.push_back(finding(file, text, "a parameter says its role in its effect's file"));
    return findings;
}

Findings notes_to_self(const SourceFile& file) {
    static const std::regex pattern(R"re(((?:\b(?:TO)(?:DO)\b|\b(?:FIX)(?:ME)\b|\bXX(?:X)\b|#if[ ]0\b)))re");
    Findings findings;
    for (const auto& note : matches(file.text, pattern, {"TOD", "FIXM", "XX", "if 0"}))
        findings.push_back(file.path + ": " + note);
    return findings;
}

}  // namespace fidservo::house
