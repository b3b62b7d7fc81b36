// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo reproduce: the published experiments, their claims as a table, their figures.
#include "src/reproduce/reproduce.h"

#include "core/rig.h"
#include "src/cli/commands.h"
#include "src/files/rig/rig_file.h"

#include <algorithm>
#include <memory>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

namespace fidservo {

namespace {

struct ReproduceOptions {
    std::filesystem::path rig_file;
    std::uint64_t seed = 1;
    std::filesystem::path out;
};

int run_reproduce(const ReproduceOptions& options) {
    load_rig(options.rig_file);
    make_output_folder(options.out);
    const auto claims = reproduce::reproduce(options.rig_file, options.out, options.seed);
    for (const reproduce::Claim& claim : claims)
        fmt::print("{:<16} {}: {}\n", reproduce::name_of(claim.outcome), claim.claim, claim.measured);
    fmt::print("report: {}\n", (options.out / "report.html").string());
    const bool all_hold = std::ranges::none_of(
        claims, [](const auto& claim) { return claim.outcome == reproduce::Outcome::fails; });
    return all_hold ? exit_done : exit_answer_is_no;
}

}  // namespace

void add_reproduce(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ReproduceOptions>();
    CLI::App* command = app.add_subcommand(
        "reproduce", "Run the published system's experiments; writes a report of its claims and figures");
    add_rig_option(*command, options->rig_file);
    command->add_option("--seed", options->seed, "Seed of all noise; same seed, same bytes")
        ->capture_default_str();
    command->add_option("--out", options->out, "New folder for the report and the recordings")
        ->type_name("DIR")
        ->required();
    add_example(*command, "fidservo reproduce --out published");
    command->callback([options, &exit_code] { exit_code = run_reproduce(*options); });
}

}  // namespace fidservo
