// fidservo inspect: a whole inspection, from a recipe to a report.
#include "src/commands/commands.h"
#include "src/commands/session_options.h"
#include "src/inspect/inspection_run.h"
#include "src/inspect/output.h"

#include <memory>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

namespace fidservo {

namespace {

int run_inspect(const inspect::InspectionOptions& options) {
    const inspect::Counts counts = inspect::run_inspection(options);
    fmt::print("{} checks: {} passed, {} failed, {} not decidable, {} not measured\n", counts.total(),
               counts.pass, counts.fail, counts.not_decidable, counts.not_measured);
    fmt::print("report: {}\n", (options.out / "report.html").string());
    return counts.pass == counts.total() ? exit_done : exit_answer_is_no;
}

}  // namespace

void add_inspect(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<inspect::InspectionOptions>();
    CLI::App* command = app.add_subcommand(
        "inspect", "Inspect a plate as a recipe says; exit code 1 if anything fails or cannot be decided");
    command->add_option("recipe", options->recipe, "What to inspect (docs/inspection.md)")
        ->required()
        ->type_name("RECIPE.yaml");
    add_session_options(*command, options->session);
    command->add_option("--out", options->out, "New folder for results, report, images and recordings")
        ->required();
    command->add_flag("--resume", options->resume,
                      "Go on with a run that was interrupted, in the same folder");
    add_example(*command, "fidservo inspect assets/demo/recipe.yaml --out out/demo");
    command->callback([options, command, &exit_code] {
        if (command->count("--seed") > 0) options->seed = options->session.seed;
        exit_code = run_inspect(*options);
    });
}

}  // namespace fidservo
