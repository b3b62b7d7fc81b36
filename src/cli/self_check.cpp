// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/self_check.h"

#include "core/parallel.h"
#include "core/rig.h"
#include "src/cli/commands.h"
#include "src/files/disk/durable_file.h"
#include "src/files/rig/rig_file.h"
#include "src/process/interrupt.h"
#include "src/selfcheck/self_check.h"
#include "src/selfcheck/tally/tally_text.h"
#include "src/selfcheck/tally_json.h"

#include <cstdio>
#include <map>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>
#include <unistd.h>

namespace fidservo {
namespace {

std::map<std::string, selfcheck::CaseKind> kinds_by_name() {
    std::map<std::string, selfcheck::CaseKind> kinds;
    for (std::size_t k = 0; k < selfcheck::kind_count; ++k) {
        const auto kind = static_cast<selfcheck::CaseKind>(k);
        kinds.emplace(selfcheck::name_of(kind), kind);
    }
    return kinds;
}

/// Over the progress bar, where stdout is the terminal that shows it.
void print_last_case(const selfcheck::SelfCheck& check) {
    constexpr const char* erase_line = "\r\033[K";
    fmt::print("{}{}\n", ::isatty(STDOUT_FILENO) == 1 ? erase_line : "", line_of_last(check));
    std::fflush(stdout);
}

}  // namespace

void add_self_check_options(CLI::App& diagnose, SelfCheckRequest& request) {
    CLI::Option* self_check = diagnose.add_flag(
        "--self-check", request.wanted,
        "Draw rigs with known effects, record, diagnose and score them; needs no RECORDING");
    const auto add = [&](const char* name, auto& value, const char* text) {
        return diagnose.add_option(name, value, text)->needs(self_check);
    };
    add("--cases", request.cases, "How many")->type_name("N")->capture_default_str();
    add("--seed", request.seed, "Same seed, same cases")->type_name("N")->capture_default_str();
    add("--first-case", request.first, "Number of the first case")->type_name("N")->capture_default_str();
    std::vector<std::string> names;
    for (const auto& [name, kind] : kinds_by_name()) names.push_back(name);
    add("--kinds", request.kinds,
        "Cases of these kinds only: none, one, two, withheld, unlisted; "
        "or, with rendered frames: frames (an effect of the image), frames-none, frames-withheld; "
        "or, with many causes at once: three, messy, messy-none; or, far off the floor whatever explains it: "
        "rough")
        ->type_name("A,B,..")
        ->delimiter(',')
        ->check(CLI::IsMember(names));
    add("--recordings", request.recordings,
        "Of each campaign these recordings only, as macro-pulses-1: with fewer, more stays tied")
        ->type_name("A,B,..")
        ->delimiter(',');
    diagnose
        .add_flag(
            "--settle-ties", request.settles_ties,
            "Where effects are tied, record the designed experiment and the best of the list, and diagnose "
            "again with each")
        ->needs(self_check);
    diagnose
        .add_flag("--by-effort", request.by_effort,
                  "Each on one core, its seconds counted by what it predicts: the same on any machine, "
                  "however busy")
        ->needs(self_check);
}

int run_self_check(const SelfCheckRequest& request, const std::filesystem::path& rig_file,
                   const std::vector<std::string>& only, const std::filesystem::path& json) {
    selfcheck::SelfCheckOptions options{
        .cases = request.cases,
        .first = request.first,
        .kinds = {},
        .seed = request.seed,
        .only = only,
        .limited = request.by_effort ? gap::Seconds::by_effort : gap::Seconds::by_clock,
        .recordings = request.recordings,
        .settles_ties = request.settles_ties};
    const auto kinds = kinds_by_name();
    for (const std::string& name : request.kinds) options.kinds.push_back(kinds.at(name));
    if (request.by_effort) use_cores(1);
    watch_for_interrupts();
    const auto after_case = [&](const selfcheck::SelfCheck& so_far) {
        print_last_case(so_far);
        if (!json.empty())
            replace_file(json, self_check_json(options, so_far, selfcheck::tally(so_far.outcomes)));
    };
    const selfcheck::SelfCheck check = selfcheck::run_self_check(load_rig(rig_file), options, after_case);
    const selfcheck::Tally tally = selfcheck::tally(check.outcomes);
    fmt::print("{}", text_of(tally));
    if (check.was_interrupted)
        fmt::print("interrupted ({}) after {} of {} cases\n", interrupt_name(), tally.cases, options.cases);
    if (!json.empty()) replace_file(json, self_check_json(options, check, tally));
    const bool is_whole = check.failures.empty() && !check.was_interrupted;
    return is_whole && keeps_all_limits(tally) ? exit_done : exit_answer_is_no;
}

}  // namespace fidservo
