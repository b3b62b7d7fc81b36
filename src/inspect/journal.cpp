// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/journal.h"

#include "core/input_error.h"
#include "src/files/disk/durable.h"
#include "src/inspect/visit_json.h"

#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fidservo::inspect {
namespace {

using nlohmann::json;

constexpr const char* format_name = "fidservo-inspection-journal/1";

json to_json(const RunIdentity& id) {
    return {{"recipe_sha256", id.recipe_sha256},
            {"rig_sha256", id.rig_sha256},
            {"plate_sha256", id.plate_sha256},
            {"printed_sha256", id.printed_sha256},
            {"calibration_sha256", id.calibration_sha256},
            {"seed", id.seed},
            {"stage", id.stage},
            {"camera", id.camera},
            {"version", id.version}};
}

RunIdentity identity_from(const json& j) {
    return {j.at("recipe_sha256"),
            j.at("rig_sha256"),
            j.at("plate_sha256"),
            j.at("printed_sha256"),
            j.at("calibration_sha256"),
            j.at("seed"),
            j.at("stage"),
            j.at("camera"),
            j.at("version")};
}

/// What differs, in words for the user; empty if nothing does.
std::string difference(const RunIdentity& then, const RunIdentity& now) {
    if (then.recipe_sha256 != now.recipe_sha256) return "the recipe has changed since";
    if (then.rig_sha256 != now.rig_sha256) return "the rig file has changed since";
    if (then.printed_sha256 != now.printed_sha256) return "the simulated plate has changed since";
    if (then.seed != now.seed) return fmt::format("it was begun with --seed {}", then.seed);
    if (then.stage != now.stage) return fmt::format("it was begun with --stage {}", then.stage);
    if (then.camera != now.camera) return fmt::format("it was begun with --camera {}", then.camera);
    if (then.version != now.version)
        return fmt::format("it was begun by version {} of the program", then.version);
    if (then != now) return "a file that the rig or the recipe names has changed since";
    return {};
}

std::string all_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(fmt::format("{}: there is no run to resume here", file.string()));
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

void take(const json& line, JournalContent& content) {
    const std::string event = line.at("event");
    if (event == "resumed") ++content.resumed;
    if (event == "visit") content.visits.push_back(visit_from(line.at("visit")));
    if (line.contains("checkpoint")) content.checkpoint = line.at("checkpoint").get<std::string>();
}

}  // namespace

Journal::Journal(const std::filesystem::path& file, const RunIdentity& identity) : file_(file) {
    append_durably(
        file_,
        json{{"event", "begun"}, {"format", format_name}, {"identity", to_json(identity)}}.dump() + "\n");
}

bool killed_before_it_began(const std::filesystem::path& journal_file) {
    const auto folder = journal_file.parent_path();
    if (!std::filesystem::is_directory(folder)) return false;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path() != journal_file) return false;
    return !std::filesystem::exists(journal_file) || all_of(journal_file).find('\n') == std::string::npos;
}

std::pair<Journal, JournalContent> Journal::resume(const std::filesystem::path& file,
                                                   const RunIdentity& identity) {
    const std::string text = all_of(file);
    const std::size_t whole = text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
    JournalContent content;
    try {
        std::istringstream lines(text.substr(0, whole));
        std::string line;
        if (!std::getline(lines, line) || json::parse(line).at("format") != format_name)
            throw InputError(
                fmt::format("{}: the run ended before it began: remove its folder", file.string()));
        content.identity = identity_from(json::parse(line).at("identity"));
        while (std::getline(lines, line)) take(json::parse(line), content);
    } catch (const json::exception& problem) {
        throw InputError(fmt::format("{}: not a journal of this program: {}", file.string(), problem.what()));
    }
    const std::string changed = difference(content.identity, identity);
    if (!changed.empty())
        throw InputError(fmt::format("{}: this run cannot be resumed: {}", file.string(), changed));
    if (whole < text.size()) std::filesystem::resize_file(file, whole);
    Journal journal(file);
    append_durably(file, json{{"event", "resumed"}}.dump() + "\n");
    ++content.resumed;
    return {std::move(journal), std::move(content)};
}

void Journal::homed(const std::string& checkpoint) {
    append_durably(file_, json{{"event", "homed"}, {"checkpoint", checkpoint}}.dump() + "\n");
}

void Journal::ended(const Visit& visit, const std::string& checkpoint) {
    append_durably(
        file_, json{{"event", "visit"}, {"visit", json_of(visit)}, {"checkpoint", checkpoint}}.dump() + "\n");
}

}  // namespace fidservo::inspect
