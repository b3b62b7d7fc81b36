// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo fleet report: what the results of a fleet come to.
#include "core/input_error.h"
#include "src/cli/commands.h"
#include "src/files/disk/durable_file.h"
#include "src/fleet/report/cured_rig.h"
#include "src/fleet/report/database.h"
#include "src/fleet/report/findings.h"
#include "src/fleet/report/fleet_json.h"
#include "src/fleet/report/fleet_page.h"
#include "src/fleet/report/judgement_words.h"
#include "src/fleet/report/unexplained.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

namespace fidservo {
namespace {

struct FleetReportOptions {
    std::filesystem::path fleet, html, json, rig_file;
};

int report_fleet(const FleetReportOptions& options) {
    demand_new_file("--html", options.html);
    demand_new_file("--json", options.json);
    const fleet::Collected collected = fleet::collect_results(options.fleet);
    for (const std::string& line : collected.damaged) fmt::print(stderr, "passed over: {}\n", line);
    if (collected.results.empty())
        throw InputError(fmt::format("{}: there is no result in it", (options.fleet / "results").string()));
    const fleet::FleetFindings findings = fleet::findings_of(collected.results);
    fmt::print("{} results of {} units, {} new, {} removed, {} passed over\n", collected.results.size(),
               findings.units.size(), collected.added, collected.removed, collected.damaged.size());
    if (!findings.unexplained.empty()) {
        constexpr std::size_t shown = 6;
        fmt::print("{}\n", fleet::unexplained_sentence(findings.unexplained));
        for (const std::string& line : fleet::unexplained_lines(findings.unexplained, findings.units, shown))
            fmt::print("  {}\n", line);
    }
    for (const fleet::Judgement& judgement : findings.judgements)
        fmt::print("{}. {}\n", fleet::whose_words(findings, judgement),
                   fleet::matter_sentence(findings, judgement));
    if (findings.judgements.empty())
        fmt::print("{}no unit stands out, and none has changed\n",
                   findings.unexplained.empty() ? "" : "by the effects that are named ");
    std::filesystem::path cured = options.fleet / "cured-rig.yaml";
    if (options.rig_file.empty() || !fleet::write_cured_rig(cured, options.rig_file, findings)) cured.clear();
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
