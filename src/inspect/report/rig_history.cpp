// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/inspect/report/rig_history.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "src/files/disk/durable.h"
#include "src/files/disk/sha256.h"
#include "src/fleet/report/findings.h"
#include "src/fleet/report/judgement_words.h"
#include "src/fleet/result_store.h"
#include "src/process/commit.h"
#include "src/report/html.h"

#include <algorithm>
#include <cstddef>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fidservo::inspect {
namespace {

std::string unit_of(const Rig& rig, const RecordingOrigin& origin) {
    return origin.unit.empty() ? rig.name : origin.unit;
}

std::string line_of(const Rig& rig, const std::string& rig_sha256, const std::string& diagnosis,
                    const RecordingOrigin& origin) {
    const nlohmann::ordered_json line{{"format", fleet::result_format},
                                      {"task",
                                       {{"kind", "diagnose"},
                                        {"campaign", "inspection of " + origin.recorded_at},
                                        {"content", sha256(diagnosis)},
                                        {"unit", unit_of(rig, origin)},
                                        {"recorded_at", origin.recorded_at},
                                        {"labels", nlohmann::ordered_json(origin.labels)}}},
                                      {"rig", {{"name", rig.name}, {"content", rig_sha256}}},
                                      {"program", program_version()},
                                      {"effort", 0.0},
                                      {"status", "done"},
                                      {"diagnosis", nlohmann::ordered_json::parse(diagnosis)}};
    return line.dump();
}

/// The runs of a history file, and what had to be passed over.
struct History {
    std::vector<fleet::FleetResult> runs;
    std::vector<std::string> passed_over;
    int lines = 0;
    bool ends_with_a_line = true;

    void add(const std::filesystem::path& file, const std::string& line) {
        ++lines;
        if (line.empty()) return;
        try {
            runs.push_back(fleet::result_of(fmt::format("{}: line {}", file.string(), lines), line));
        } catch (const InputError& error) {
            passed_over.emplace_back(error.what());
        }
    }
};

History read_history(const std::filesystem::path& file) {
    History history;
    std::ifstream stream(file, std::ios::binary);
    for (std::string line; std::getline(stream, line);) {
        history.ends_with_a_line = !stream.eof();
        history.add(file, line);
    }
    return history;
}

}  // namespace

HistoryFindings append_to_history(const std::filesystem::path& file, const Rig& rig,
                                  const std::string& rig_sha256, const RigFindings& findings,
                                  const RecordingOrigin& origin) {
    HistoryFindings said;
    if (findings.diagnosis.empty()) {
        said.lines.emplace_back("history: this run is not in it, as nothing was diagnosed");
        return said;
    }
    History history = read_history(file);
    const std::string line = line_of(rig, rig_sha256, findings.diagnosis, origin);
    // A line that a killed run has left unfinished is ended first.
    append_durably(file, (history.ends_with_a_line ? "" : "\n") + line + "\n");
    history.add(file, line);
    for (const std::string& why : history.passed_over) said.lines.push_back("history: passed over: " + why);
    const fleet::FleetFindings changes = fleet::findings_of(history.runs);
    const std::string unit = unit_of(rig, origin);
    const auto is_its_own = [&](std::size_t u) { return changes.units[u].name == unit; };
    const auto own = std::ranges::find(changes.units, unit, &fleet::UnitHistory::name);
    const std::size_t runs = own->results.size(), judged = runs - own->first_judged;
    const std::string with_this_file =
        judged < runs ? fmt::format(", {} of them with this rig file, which alone are compared", judged) : "";
    for (const fleet::Judgement& judgement : changes.judgements) {
        if (judgement.matter == fleet::Matter::deviation || std::ranges::none_of(judgement.units, is_its_own))
            continue;
        const std::string text = fleet::matter_sentence(changes, judgement);
        said.lines.push_back("warning: the rig has changed. " + text);
        said.html +=
            fmt::format("<p class=\"bad\"><strong class=\"badge\">The rig has changed.</strong> {}</p>\n",
                        report::escaped(text));
    }
    if (said.html.empty())
        said.html =
            fmt::format("<p>Over the {} runs of its history{} the rig has not changed significantly.</p>\n",
                        runs, with_this_file);
    said.lines.push_back(
        fmt::format("history: {} ({} runs of {}{})", file.string(), runs, unit, with_this_file));
    return said;
}

}  // namespace fidservo::inspect
