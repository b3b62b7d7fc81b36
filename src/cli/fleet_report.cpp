// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo fleet report: what the results of a fleet come to.
#include "core/input_error.h"
#include "src/cli/commands.h"
#include "src/files/disk/durable_file.h"
#include "src/files/rig/rig_file.h"
#include "src/fleet/content.h"
#include "src/fleet/report/cured_rig.h"
#include "src/fleet/report/database.h"
#include "src/fleet/report/findings.h"
#include "src/fleet/report/fleet_json.h"
#include "src/fleet/report/fleet_page.h"
#include "src/fleet/report/judgement_words.h"
#include "src/fleet/report/unexplained.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

namespace fidservo {
namespace {

struct FleetReportOptions {
    std::filesystem::path fleet, html, json, rig_file;
};

/// Throws InputError where no result is of this rig file.
void demand_its_rig(const std::filesystem::path& rig_file, const std::vector<fleet::FleetResult>& results) {
    if (rig_file.empty()) return;
    const std::string content = fleet::content_of_files(files_of_rig(rig_file));
    if (std::ranges::find(results, content, &fleet::FleetResult::rig_content) != results.end()) return;
    throw InputError(
        fmt::format("--rig: {}: no campaign was diagnosed with it as it is now; allowed: the rig file "
                    "of these results, {}",
                    rig_file.string(), results.back().rig_name));
}

int report_fleet(const FleetReportOptions& options) {
    demand_new_file("--html", options.html);
    demand_new_file("--json", options.json);
    const fleet::Collected collected = fleet::collect_results(options.fleet);
    for (const std::string& line : collected.damaged) fmt::print(stderr, "passed over: {}\n", line);
    if (collected.results.empty())
        throw InputError(fmt::format("{}: there is no result in it", (options.fleet / "results").string()));
    demand_its_rig(options.rig_file, collected.results);
    const fleet::FleetFindings findings = fleet::findings_of(collected.results);
    fmt::print("{} results of {} units, {} new, {} removed, {} passed over\n", collected.results.size(),
               findings.units.size(), collected.added, collected.removed, collected.damaged.size());
    if (const std::string failed = fleet::not_diagnosed_sentence(findings.unexplained, findings.units);
        !failed.empty())
        fmt::print("{}\n", failed);
    if (!findings.unexplained.empty()) {
        constexpr std::size_t shown = 6;
        fmt::print("{}\n", fleet::unexplained_sentence(findings.unexplained));
        for (const std::string& line : fleet::unexplained_lines(findings.unexplained, findings.units, shown))
            fmt::print("  {}\n", line);
    }
    for (const fleet::Judgement& judgement : findings.judgements)
        fmt::print("{}. {}\n", fleet::whose_words(findings, judgement),
                   fleet::matter_sentence(findings, judgement));
    for (const std::string& line : fleet::named_but_not_judged(collected.results)) fmt::print("{}\n", line);
    if (findings.judgements.empty()) fmt::print("{}\n", fleet::nothing_stands_out(findings));
    std::filesystem::path cured = options.fleet / "cured-rig.yaml";
    if (!options.rig_file.empty()) {
        const fleet::CuredRig written =
            fleet::write_cured_rig(cured, options.rig_file, collected.results, findings);
        for (const std::string& effect : written.left_out)
            fmt::print("{}: is in no cured rig file, as units do not agree on its other parameters\n",
                       effect);
        if (!written.is_written) cured.clear();
    } else {
        cured.clear();
    }
    if (!cured.empty()) fmt::print("rig file that cures what all share: {}\n", cured.string());
    fmt::print("database: {}\n", (options.fleet / "fleet.sqlite").string());
    if (!options.json.empty()) write_or_throw(options.json, fleet::fleet_json(collected, findings, cured));
    if (!options.html.empty()) {
        write_or_throw(options.html, fleet::fleet_page(options.fleet, collected, findings, cured));
        fmt::print("report: {}\n", options.html.string());
    }
    return exit_done;
}

}  // namespace

void add_fleet_report(CLI::App& group, int& exit_code) {
    auto options = std::make_shared<FleetReportOptions>();
    CLI::App* command = group.add_subcommand(
        "report", "Which unit is off, since when and by what; is it the unit, its batch, or the model");
    command->add_option("FLEET", options->fleet, "Folder that fleet diagnose --out made")->required();
    command->add_option("--html", options->html, "New file for the report")->type_name("FILE.html");
    command->add_option("--json", options->json, "New file for the same, for programs")->type_name("FILE");
    command
        ->add_option(
            "--rig", options->rig_file,
            "The rig file that the campaigns were diagnosed with: FLEET/cured-rig.yaml then states what "
            "all units share")
        ->type_name("RIG.yaml");
    add_example(*command, "fidservo fleet report fleet --html fleet.html --json fleet.json");
    command->callback([options, &exit_code] { exit_code = report_fleet(*options); });
}

}  // namespace fidservo
