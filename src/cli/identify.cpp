// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo identify and fidservo calibrate: models' numbers from recordings, into a rig file.
#include "src/identify/identify.h"

#include "core/input_error.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "src/cli/commands.h"
#include "src/files/recording/reader.h"
#include "src/files/rig/rig_file.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

namespace fidservo {

namespace {

constexpr std::array<std::string_view, 3> drive_roles{"input", "output", "time"};
constexpr std::array<std::string_view, 4> heater_roles{"input", "output", "ambient", "time"};

constexpr std::array identifications{
    Identification{"macro", "Dead zone, gain, time constant and friction of the macro stage", identify_macro,
                   drive_roles, 2},
    Identification{"hysteresis", "The wire's first-order descending curves (Preisach model)",
                   identify_hysteresis, drive_roles, 2},
    Identification{"heater", "Onset, gain and time constants of the wire's heater", identify_heater,
                   heater_roles, 2}};

constexpr std::array calibrations{Identification{
    "hall", "The Hall sensor's curve against a reference displacement", calibrate_hall, drive_roles, 2}};

struct IdentifyOptions {
    std::vector<std::filesystem::path> recordings;
    std::filesystem::path table;
    std::string columns;
    double rate_hz = 0.0;
    TableOptions form;  ///< of the table
    std::filesystem::path rig_file;
    std::filesystem::path json;
    std::filesystem::path write_rig;
};

IdentifyInput read_table_input(const IdentifyOptions& options, const Identification& identification) {
    IdentifyInput input{load_rig(options.rig_file), {}, std::nullopt, options.rate_hz};
    if (options.columns.empty())
        throw InputError(fmt::format("--columns: missing: which column of the table is what, e.g. {}=1,{}=2",
                                     identification.roles[0], identification.roles[1]));
    input.table = read_text_table(
        options.table, parse_columns(options.columns, identification.roles, identification.required),
        options.form);
    if (options.rate_hz < 0.0)
        throw InputError(fmt::format("--rate-hz: {}: must be above 0", options.rate_hz));
    if ((options.rate_hz > 0.0) == (input.table->find("time") != nullptr))
        throw InputError(
            "--rate-hz: a table needs either this, rows a second, or a column with the role time");
    return input;
}

IdentifyInput read_input(const IdentifyOptions& options, const Identification& identification) {
    if (options.table.empty() == options.recordings.empty())
        throw InputError("RECORDING: give recordings or --table, one of the two");
    if (!options.table.empty()) return read_table_input(options, identification);
    if (!options.columns.empty() || options.rate_hz > 0.0 || options.form.header_lines ||
        options.form.decimal || options.form.separator)
        throw InputError(
            "--columns, --rate-hz, --header-lines, --decimal, --separator: are for --table only");
    IdentifyInput input{load_rig(options.rig_file), {}, std::nullopt, 0.0};
    for (const std::filesystem::path& path : options.recordings)
        for (const std::filesystem::path& folder : find_recordings(path)) {
            input.recordings.push_back(read_recording(folder));
            if (input.recordings.back().rig != input.rig.name)
                spdlog::warn("{}: is a recording of the rig {}, read with the rig file of {}",
                             folder.string(), input.recordings.back().rig, input.rig.name);
            if (input.recordings.back().rows.empty())
                throw InputError(
                    fmt::format("{}: holds no rows of the stage (stage0/data.csv)", folder.string()));
        }
    return input;
}

/// Numbers from a rig that is known to have such effects contain them: beside them in a file they would act
/// twice. Friction and offset are identified themselves, and replaced.
void demand_not_stated(const Rig& rig, const Identification& identification) {
    const bool macro = identification.name == "macro";
    for (const StatedEffect& effect : rig.effects) {
        const bool of_macro = plant::setting_of(effect).effect->block.starts_with("macro.");
        const bool replaced = effect.name == "coulomb_friction" || effect.name == "drive_offset";
        if (of_macro == macro && !replaced)
            throw InputError(fmt::format(
                "--rig: states the effect {}: identified numbers would contain it, and the new file would "
                "have it twice; give a rig file without it, or leave out --write-rig",
                effect.name));
    }
}

int run_identification(const IdentifyOptions& options, const Identification& identification) {
    demand_new_file("--json", options.json);
    demand_new_file("--write-rig", options.write_rig);
    if (!options.json.empty() && options.json.lexically_normal() == options.write_rig.lexically_normal())
        throw InputError(fmt::format("--json, --write-rig: {}: are one file", options.json.string()));
    const IdentifyInput input = read_input(options, identification);
    if (!options.write_rig.empty()) demand_not_stated(input.rig, identification);
    Identified identified = identification.run(input);
    if (input.table)
        identified.notes.insert(identified.notes.begin(), input.table->notes.begin(),
                                input.table->notes.end());
    fmt::print("{}", describe(identified));
    if (!options.json.empty()) write_identification_json(options.json, identified);
    if (!options.write_rig.empty() && fits_a_rig_file(identified)) {
        write_identified_rig(options.write_rig, options.rig_file, identified);
        fmt::print("rig file: {}\n", options.write_rig.string());
    } else if (!options.write_rig.empty()) {
        fmt::print("no rig file: nothing was identified that it could hold\n");
    }
    return identified.undetermined.empty() ? exit_done : exit_answer_is_no;
}

/// What a table does not tell of itself.
void add_table_form(CLI::App& command, TableOptions& form) {
    constexpr int most_lines = 1'000'000;
    command.add_option("--header-lines", form.header_lines, "Lines of the table above its rows of numbers")
        ->check(CLI::Range(0, most_lines))
        ->option_text("N");
    command.add_option("--decimal", form.decimal, "Decimal sign of the table's numbers: point or comma")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, DecimalSign>{{"point", DecimalSign::point}, {"comma", DecimalSign::comma}}))
        ->option_text("SIGN");
    command
        .add_option("--separator", form.separator,
                    "What stands between the table's fields: tab, semicolon, comma, bar or blank")
        ->transform(CLI::CheckedTransformer(std::map<std::string, char>{
            {"tab", '\t'}, {"semicolon", ';'}, {"comma", ','}, {"bar", '|'}, {"blank", ' '}}))
        ->option_text("NAME");
}

void add_identification(CLI::App& parent, const Identification& identification, int& exit_code) {
    auto options = std::make_shared<IdentifyOptions>();
    CLI::App* command =
        parent.add_subcommand(std::string(identification.name), std::string(identification.help));
    command->add_option("RECORDING", options->recordings, "Recording folders, or folders that hold some")
        ->option_text("...");
    command->add_option("--table", options->table, "A text table in place of recordings")->type_name("FILE");
    command
        ->add_option(
            "--columns", options->columns,
            fmt::format(
                "ROLE=COLUMN,...: a column's number or title, its unit in brackets: input=1,output=5[um]; "
                "roles: {}",
                fmt::join(identification.roles, ", ")))
        ->type_name("COLUMNS");
    command->add_option("--rate-hz", options->rate_hz, "Rows of the table a second")->type_name("HZ");
    add_table_form(*command, options->form);
    add_rig_option(*command, options->rig_file);
    command->add_option("--json", options->json, "New file for values, standard errors and residuals")
        ->type_name("FILE");
    command->add_option("--write-rig", options->write_rig, "New rig file with the identified values")
        ->type_name("FILE.yaml");
    add_example(*command, fmt::format("fidservo {} {} recordings/ --write-rig identified.yaml",
                                      parent.get_name(), identification.name));
    command->callback(
        [options, &identification, &exit_code] { exit_code = run_identification(*options, identification); });
}

CLI::App& add_group(CLI::App& app, const std::string& name, const std::string& help,
                    std::span<const Identification> members, int& exit_code) {
    CLI::App* group = app.add_subcommand(name, help);
    group->require_subcommand(0, 1);
    for (const Identification& member : members) add_identification(*group, member, exit_code);
    group->callback([group, name] {
        if (!group->get_subcommands().empty()) return;
        std::vector<std::string> names;
        for (const CLI::App* member : group->get_subcommands([](CLI::App*) { return true; }))
            names.push_back(member->get_name());
        throw InputError(fmt::format("{}: what? One of: {}", name, fmt::join(names, ", ")));
    });
    return *group;
}

}  // namespace

void add_identify(CLI::App& app, int& exit_code) {
    add_group(app, "identify", "Identify a model's numbers from recordings", identifications, exit_code);
}

void add_calibrate(CLI::App& app, int& exit_code) {
    CLI::App& group = add_group(app, "calibrate", "Calibrate a sensor or the stage", calibrations, exit_code);
    add_calibrate_camera(group, exit_code);
    add_calibrate_stage(group, exit_code);
}

}  // namespace fidservo
