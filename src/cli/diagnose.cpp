// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo diagnose: where recordings of a rig and its simulator disagree, and by which effect.
#include "core/input_error.h"
#include "core/rig.h"
#include "src/cli/commands.h"
#include "src/cli/self_check.h"
#include "src/compare/comparison.h"
#include "src/compare/same_rig.h"
#include "src/diagnose/designed_experiment.h"
#include "src/diagnose/diagnose_recordings.h"
#include "src/diagnose/diagnosis_json.h"
#include "src/diagnose/report/report.h"
#include "src/diagnose/search_progress.h"
#include "src/files/disk/durable_file.h"
#include "src/files/rig/effects_file.h"
#include "src/files/rig/rig_file.h"
#include "src/files/rig/stage_keys.h"
#include "src/process/interrupt.h"

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

namespace fidservo {
namespace {

struct DiagnoseOptions {
    std::vector<std::filesystem::path> recordings;
    std::filesystem::path rig_file;
    diagnose::Asked asked;
    std::filesystem::path json, report, write_rig, write_experiment;
    std::vector<std::filesystem::path> compare;
    SelfCheckRequest self_check;
};

int check_itself(const DiagnoseOptions& options) {
    if (!options.recordings.empty()) throw InputError("--self-check: it makes its own recordings; give none");
    if (!options.asked.without.empty())
        throw InputError("--self-check: it withholds effects itself; no --without");
    if (!options.asked.effects_file.empty())
        throw InputError("--self-check: it draws effects itself; no --effects-file");
    if (!options.asked.matters.empty())
        throw InputError("--self-check: it judges by the floor; no --matters");
    if (!options.report.empty() || !options.write_rig.empty() || !options.write_experiment.empty())
        throw InputError("--self-check: writes --json only, no --report, --write-rig and --write-experiment");
    demand_effects("--effects", options.asked.only, {});
    return run_self_check(options.self_check, options.rig_file, options.asked.only, options.json);
}

/// `record` and `simulate` know a file that describes an experiment by its ending.
void demand_experiment_file(const std::filesystem::path& file) {
    if (!file.empty() && file.extension() != ".yaml" && file.extension() != ".yml")
        throw InputError(
            fmt::format("--write-experiment: {}: the name must end in .yaml or .yml, as record and "
                        "simulate know an experiment file by that",
                        file.string()));
}

/// Designs the experiment that --write-experiment asks for, writes it and proposes it. Without one the
/// diagnosis says why.
std::shared_ptr<const diagnose::DesignedNext> write_experiment(const DiagnoseOptions& options,
                                                               const gap::Evidence& evidence,
                                                               gap::Diagnosis& diagnosis) {
    if (options.write_experiment.empty()) return nullptr;
    evidence.budget()->end_search();
    evidence.budget()->prolong(diagnose::design_limit_s);
    diagnose::SearchProgress progress(diagnose::design_limit_s);
    diagnose::DesignRequest request{.file = options.write_experiment, .wire_limit_degC = {}};
    if (evidence.rig().micro)
        request.wire_limit_degC =
            watchdog_params(evidence.rig(), load_stage_keys(options.rig_file).watchdog).wire_limit_degC;
    const diagnose::DesignAnswer answer = diagnose::design_next(
        evidence, diagnosis, request, [&](std::string_view what) { progress.tell(what); });
    if (answer.next) {
        write_or_throw(options.write_experiment, diagnose::file_text(*answer.next));
        diagnosis.next_experiment = diagnose::proposal_of(*answer.next);
    } else {
        diagnosis.notes.push_back(fmt::format("no experiment was written to {}: {}",
                                              options.write_experiment.string(), answer.why_none));
    }
    return answer.next;
}

int diagnose_rig(const DiagnoseOptions& options, const Rig& rig, const gap::DiagnosisOptions& what) {
    diagnose::Conduct conduct{.interrupted = interrupt_requested};
    diagnose::ReadRecordings read = diagnose::read_recordings(options.recordings, interrupt_requested);
    diagnose::SearchProgress progress(diagnose::time_limit(read.recordings).whole_s);
    conduct.tell = [&](std::string_view tried, double) { progress.tell(tried); };
    auto [evidence, diagnosis, limit] = diagnose::diagnose_recordings(rig, std::move(read), what, conduct);
    const auto designed = write_experiment(options, evidence, diagnosis);
    evidence.budget()->end();
    fmt::print("{}", describe(diagnosis));
    if (!options.json.empty()) write_or_throw(options.json, diagnosis_json(diagnosis));
    if (designed) fmt::print("experiment: {}\n", options.write_experiment.string());
    if (!options.report.empty()) {
        write_or_throw(options.report, diagnose::diagnosis_report(evidence, diagnosis,
                                                                  {.rig_file = options.rig_file,
                                                                   .recordings = options.recordings,
                                                                   .only = options.asked.only,
                                                                   .without = options.asked.without,
                                                                   .written_rig = options.write_rig,
                                                                   .designed = designed}));
        fmt::print("report: {}\n", options.report.string());
    }
    if (!options.write_rig.empty()) {
        write_diagnosed_rig(options.write_rig, options.rig_file, diagnosis);
        fmt::print("rig file: {}\n", options.write_rig.string());
    }
    return exit_done;
}

int compare_sets(const DiagnoseOptions& options, const Rig& rig) {
    if (!options.recordings.empty())
        throw InputError("--compare: A and B are all that is compared; no RECORDING");
    if (!options.asked.only.empty() || !options.asked.without.empty() ||
        !options.asked.effects_file.empty() || !options.asked.matters.empty() || !options.report.empty() ||
        !options.write_rig.empty() || !options.write_experiment.empty())
        throw InputError("--compare: takes --rig and --json only");
    diagnose::ReadRecordings a = diagnose::read_recordings({options.compare[0]});
    diagnose::ReadRecordings b = diagnose::read_recordings({options.compare[1]});
    for (std::string& note : compare::notes_on_rigs(options.compare[0], options.compare[1]))
        b.notes.push_back(std::move(note));
    diagnose::SearchProgress progress(2.0 * diagnose::half_a_minute.whole_s);
    const compare::Comparison comparison =
        compare::compare(rig, std::move(a), std::move(b), interrupt_requested,
                         [&](std::string_view what) { progress.tell(what); });
    fmt::print("{}", compare::describe(comparison));
    if (!options.json.empty()) write_or_throw(options.json, compare::comparison_json(comparison));
    return exit_done;
}

int run_diagnose(const DiagnoseOptions& options) {
    demand_new_file("--json", options.json);
    diagnose::keep_memory();
    if (options.self_check.wanted) return check_itself(options);
    if (options.recordings.empty() && options.compare.empty())
        throw InputError("RECORDING: give one recording folder at least");
    demand_new_file("--report", options.report);
    demand_new_file("--write-rig", options.write_rig);
    demand_new_file("--write-experiment", options.write_experiment);
    demand_experiment_file(options.write_experiment);
    const Rig rig = load_rig(options.rig_file);
    const gap::DiagnosisOptions what = diagnose::options_of(options.asked, rig);
    try {
        if (!options.compare.empty()) return compare_sets(options, rig);
        return diagnose_rig(options, rig, what);
    } catch (const gap::BudgetEnded& end) {
        const bool by_user = end.how() == gap::Ended::interrupted;
        fmt::print("{}: nothing was predicted by then, nothing was written\n",
                   by_user ? fmt::format("interrupted ({})", interrupt_name()) : "the time was over");
        return exit_answer_is_no;
    }
}

}  // namespace

void add_diagnose(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<DiagnoseOptions>();
    CLI::App* command = app.add_subcommand(
        "diagnose", "Where recordings of a rig and its simulator disagree, and by which effect");
    command
        ->add_option("RECORDING", options->recordings,
                     "Recording folders, or folders that hold some; frames are judged where they have them")
        ->option_text("...");
    add_rig_option(*command, options->rig_file);
    command->add_option("--effects", options->asked.only, "Try these effects only")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("A,B,..");
    command
        ->add_option("--without", options->asked.without,
                     "Leave these effects out, and those no data tell from them")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("A,B,..");
    command
        ->add_option("--effects-file", options->asked.effects_file,
                     "Effects as formulas (docs/effects.md) that are tried beside the listed ones")
        ->type_name("FILE");
    command
        ->add_option(
            "--matters", options->asked.matters,
            "What may stay unexplained of a signal without being called a gap: encoder=20um,tag=0.1px")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("SIGNAL=VALUE,..");
    command->add_option("--json", options->json, "New file for the whole diagnosis")->type_name("FILE");
    command->add_option("--report", options->report, "New file for the report")->type_name("FILE.html");
    command->add_option("--write-rig", options->write_rig, "New rig file that states the effects found")
        ->type_name("FILE.yaml");
    command
        ->add_option("--write-experiment", options->write_experiment,
                     "New experiment file for record: the 30 s that tell best what these recordings leave "
                     "open; a minute more")
        ->type_name("FILE.yaml");
    command
        ->add_option("--compare", options->compare,
                     "Two sets of recordings of one rig: what has changed from the first to the second")
        ->expected(2)
        ->type_name("A B");
    add_self_check_options(*command, options->self_check);
    add_example(*command, "fidservo diagnose --rig assets/rig.yaml recordings/ --json diagnosis.json");
    command->callback([options, &exit_code] { exit_code = run_diagnose(*options); });
}

}  // namespace fidservo
