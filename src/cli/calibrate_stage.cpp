// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo calibrate stage: the camera-to-stage map, Hall sensor and encoder against the plate; a check of
// them.
#include "src/calibrate/calibrate_stage.h"

#include "core/input_error.h"
#include "core/result.h"
#include "core/rig.h"
#include "plant/effects/catalogue.h"
#include "src/cli/commands.h"
#include "src/cli/session_options.h"
#include "src/files/disk/output_paths.h"
#include "src/files/rig/plate_file.h"
#include "src/files/rig/rig_file.h"
#include "src/process/progress.h"
#include "src/session/pilot.h"

#include <algorithm>
#include <memory>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

namespace fidservo {

namespace {

struct StageOptions {
    SessionOptions session;
    std::filesystem::path out;
    std::filesystem::path write_rig;
    bool check = false;
};

void demand_sound(const StageOptions& options) {
    if (options.check && !options.write_rig.empty())
        throw InputError("--check, --write-rig: a check writes no rig file; leave one of the two out");
    if (!options.check && options.out.empty())
        throw InputError("--out: missing: a new folder for the report and the recording");
    demand_new_file("--write-rig", options.write_rig);
    if (!options.out.empty() && options.out.lexically_normal() == options.write_rig.lexically_normal())
        throw InputError(fmt::format("--out, --write-rig: {}: are one name", options.out.string()));
}

/// Calibrated numbers contain such effects: beside them in a file they would act twice.
void demand_no_geometry_stated(const Rig& rig) {
    for (const StatedEffect& effect : rig.effects) {
        const std::string_view block = plant::setting_of(effect).effect->block;
        if (block == "camera.geometry" || block == "macro.encoder" || block == "micro.hall")
            throw InputError(fmt::format(
                "--rig: states the effect {}: calibrated numbers would contain it, and the new file would "
                "have it twice; state it in the file of --sim-rig, or leave out --write-rig",
                effect.name));
    }
}

/// All stands of a plan on a homed rig.
Result<std::vector<StageShot>> survey(Session& session, const StagePlan& plan) {
    StageSurvey stands(session.pilot(), plan);
    Progress progress("stands", stands.expected_shots());
    auto shots = stands.run([&] { progress.advance(); });
    progress.finish();
    return shots;
}

int run_check(const StageOptions& options, const Rig& rig, Session& session) {
    if (const auto homed = session.home(); !homed) return end_of_run("homing", homed.error());
    auto shots = survey(session, quick_plan);
    if (!shots) return end_of_run("check", shots.error());
    const auto numbers = stage_numbers(rig, *shots);
    if (!numbers) return end_of_run("check", numbers.error());
    const std::vector<calib::DriftVerdict> verdicts = calib::judge_drift(expectations(rig, *numbers));
    fmt::print("{}", describe(verdicts));
    const bool healthy = std::ranges::none_of(verdicts, &calib::DriftVerdict::drifted);
    fmt::print("{} after {:.0f} s of rig time\n", healthy ? "healthy" : "drifted", session.now_s());
    if (!options.out.empty()) write_stage_check(options.out, verdicts);
    return healthy ? exit_done : exit_answer_is_no;
}

int run_calibration(const StageOptions& options, const Rig& rig, Session& session) {
    session.record_to(options.out / "recording", "stage calibration");
    const auto leave = [&](const char* what, const Failure& why) {
        session.leave_recording();
        return end_of_run(what, why);
    };
    if (const auto homed = session.home(); !homed) return leave("homing", homed.error());
    auto shots = survey(session, StagePlan{});
    if (!shots) return leave("calibrate stage", shots.error());
    if (const auto closed = session.end_recording(); !closed) throw RunFault(closed.error().text);
    StageCalibration calibration{std::move(*shots), {}, {}, session.now_s()};
    auto numbers = stage_numbers(rig, calibration.shots);
    if (!numbers) return end_of_run("calibrate stage", numbers.error());
    calibration.numbers = std::move(*numbers);
    calibration.tests = test_fresh(calibration.numbers, calibration.shots);
    write_stage_calibration(options.out, rig, calibration);
    fmt::print("stage, {} stands in {:.0f} s of rig time\n{}", calibration.shots.size(),
               calibration.rig_time_s, describe(rig, calibration));
    if (!options.write_rig.empty() && !calibration.passed()) {
        fmt::print("no rig file: fresh moves do not confirm the calibration\n");
    } else if (!options.write_rig.empty()) {
        write_stage_rig(options.write_rig, options.session.rig_file, rig, calibration);
        fmt::print("rig file: {}\n", options.write_rig.string());
    }
    fmt::print("report: {}\n", (options.out / "report.html").string());
    return calibration.passed() ? exit_done : exit_answer_is_no;
}

int run_calibrate_stage(const StageOptions& options) {
    demand_sound(options);
    const Rig rig = load_rig(options.session.rig_file);
    const Plate plate = rig_plate(rig, options.session.rig_file);
    if (!options.write_rig.empty()) demand_no_geometry_stated(rig);
    const std::filesystem::path& truth = options.session.sim_rig_file;
    const Plate printed = truth.empty() ? plate : rig_plate(load_rig(truth), truth);
    Session session(options.session, rig, plate, printed);
    if (!options.out.empty()) make_output_folder(options.out);
    return options.check ? run_check(options, rig, session) : run_calibration(options, rig, session);
}

}  // namespace

void add_calibrate_stage(CLI::App& calibrate, int& exit_code) {
    auto options = std::make_shared<StageOptions>();
    CLI::App* command = calibrate.add_subcommand("stage",
                                                 "The camera-to-stage map, the Hall sensor's curve and the "
                                                 "encoder's scale against the plate, from moves; "
                                                 "exit code 1 if fresh moves do not confirm them");
    command->add_option("--out", options->out, "New folder for the report, the numbers and the recording")
        ->type_name("DIR");
    command
        ->add_option("--write-rig", options->write_rig,
                     "New rig file with the calibrated values, if fresh moves confirm them")
        ->type_name("FILE.yaml");
    command->add_flag("--check", options->check,
                      "A few quick moves against what the rig file says: what has drifted; exit code 1 if "
                      "anything has");
    add_session_options(*command, options->session);
    add_sim_rig_option(*command, options->session);
    add_example(*command,
                "fidservo calibrate stage --out calibrated --write-rig calibrated.yaml\n"
                "  fidservo calibrate stage --check --rig calibrated.yaml");
    command->callback([options, &exit_code] { exit_code = run_calibrate_stage(*options); });
}

}  // namespace fidservo
