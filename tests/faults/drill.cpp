// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/faults/drill.h"

#include "control/output_board.h"
#include "core/input_error.h"
#include "core/rig.h"

#include <fstream>
#include <memory>
#include <sstream>

#include <nlohmann/json.hpp>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

namespace fidservo::testing {

namespace {

namespace fs = std::filesystem;

constexpr const char* recipe = FIDSERVO_SOURCE_DIR "/tests/faults/drill.yaml";

/// Catches the program's log while it lives.
class LogCatcher {
  public:
    LogCatcher() : before_(spdlog::default_logger()) {
        spdlog::set_default_logger(std::make_shared<spdlog::logger>(
            "caught", std::make_shared<spdlog::sinks::ostream_sink_mt>(text_)));
    }
    ~LogCatcher() { spdlog::set_default_logger(before_); }
    LogCatcher(const LogCatcher&) = delete;
    LogCatcher& operator=(const LogCatcher&) = delete;
    std::string text() const { return text_.str(); }

  private:
    std::ostringstream text_;
    std::shared_ptr<spdlog::logger> before_;
};

std::vector<std::string> lines_of(const fs::path& file) {
    std::ifstream stream(file);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::optional<double> number(const std::string& text) {
    return text.empty() ? std::nullopt : std::optional(std::stod(text));
}

}  // namespace

std::string text_of_file(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

Drill::Drill(const fs::path& folder) : folder_(folder), whole_(folder / "whole") {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "guardian");
    inspect::run_inspection(options(whole_));
    const auto journal = lines_of(whole_ / "journal.jsonl");
    second_visit_s_ = nlohmann::json::parse(journal.at(3)).at("visit").at("from_s");
    fs::create_directories(folder_ / "homed/recordings");
    std::ofstream(folder_ / "homed/journal.jsonl") << journal.at(0) << '\n' << journal.at(1) << '\n';
}

inspect::InspectionOptions Drill::options(const fs::path& out) const {
    inspect::InspectionOptions options;
    options.recipe = recipe;
    options.session.rig_file = fs::path(FIDSERVO_ASSETS_DIR) / "rig.yaml";
    options.session.guardian_folder = folder_ / "guardian";
    options.out = out;
    return options;
}

DrillEnd Drill::run(const std::string& name, const std::vector<Fault>& faults) const {
    fs::copy(folder_ / "homed", out(name), fs::copy_options::recursive);
    return go_on(name, faults);
}

DrillEnd Drill::run_from_start(const std::string& name, const std::vector<Fault>& faults) const {
    inspect::InspectionOptions of_run = options(out(name));
    of_run.session.faults = faults;
    return end_of(of_run);
}

DrillEnd Drill::resume(const std::string& name) const {
    return go_on(name, {});
}

DrillEnd Drill::go_on(const std::string& name, const std::vector<Fault>& faults) const {
    inspect::InspectionOptions of_run = options(out(name));
    of_run.resume = true;
    of_run.session.faults = faults;
    return end_of(of_run);
}

fs::path Drill::recipe_with(const std::string& name, const std::string& keys) const {
    const fs::path file = folder_ / (name + ".yaml");
    std::ofstream(file) << text_of_file(recipe) << keys;
    return file;
}

DrillEnd Drill::run_waiting_for_the_camera(const std::string& name, const std::vector<Fault>& faults) const {
    inspect::InspectionOptions of_run = options(out(name));
    of_run.recipe = recipe_with(name, "camera_reconnect_s: 10\n");
    of_run.session.faults = faults;
    return end_of(of_run);
}

DrillEnd Drill::run_with_wrong_tag(const std::string& name) const {
    std::ofstream plate(folder_ / "wrong_tag_plate.yaml");
    plate << "side_mm: 1.2\ntags:\n";
    for (int tag = 0; tag <= 100; ++tag)
        plate << "  - { id: "
              << (tag == 52   ? 80
                  : tag == 80 ? 52
                              : tag)
              << ", centre_mm: [" << 2 * tag << ", 0] }\n";
    plate << "features:\n";
    for (const int site : {40, 52, 64})
        plate << "  - { dot: dot@" << site << ", centre_mm: [" << 2 * site + 1
              << ", -1.3], diameter_um: 300 }\n"
              << "  - { pad: pad@" << site << ", centre_mm: [" << 2 * site - 1
              << ", -1.3], width_um: 600, height_um: 400 }\n";
    plate.close();
    inspect::InspectionOptions of_run = options(out(name));
    of_run.recipe = recipe_with(name, "simulation:\n  plate: wrong_tag_plate.yaml\n");
    return end_of(of_run);
}

DrillEnd Drill::end_of(const inspect::InspectionOptions& of_run) const {
    DrillEnd end;
    const LogCatcher log;
    try {
        inspect::run_inspection(of_run);
    } catch (const RunFault& fault) {
        end.stopped = true;
        end.text = fault.what();
    }
    end.text += "\n" + log.text() + text_of_file(of_run.out / "journal.jsonl");
    const control::StageCommand outputs =
        control::SimulatedBoard::outputs(folder_ / "guardian/stage-outputs");
    end.outputs_zero = outputs.macro_V == 0.0 && outputs.micro_V == 0.0;
    return end;
}

std::map<std::string, MeasuredRow> measured_rows(const fs::path& results_csv) {
    std::map<std::string, MeasuredRow> rows;
    const auto lines = lines_of(results_csv);
    for (std::size_t k = 1; k < lines.size(); ++k) {
        std::vector<std::string> fields;
        std::istringstream line(lines[k]);
        for (std::string field; std::getline(line, field, ',');) fields.push_back(field);
        fields.resize(12);
        rows[fields[0] + "," + fields[1] + "," + fields[2] + "," + fields[3]] = {
            number(fields[4]), number(fields[6]), fields[9]};
    }
    return rows;
}

}  // namespace fidservo::testing
