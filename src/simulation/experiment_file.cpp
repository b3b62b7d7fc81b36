// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/simulation/experiment_file.h"

#include "core/rig.h"
#include "src/files/text/yaml_reader.h"
#include "src/simulation/pieces.h"

#include <algorithm>
#include <cctype>
#include <numbers>

#include <fmt/format.h>

namespace fidservo {

namespace {

/// A recording is kept in memory until its experiment ends.
constexpr double longest_experiment_s = 3600.0;

/// What a stage can be told.
struct Abilities {
    double low_V, high_V;
    double low_mm, high_mm;
    double tick_s;
    std::string no_controller;  ///< why setpoints cannot be followed; empty if they can
};

/// Where one piece's numbers stand: the keys end in V for a voltage, in mm for a setpoint.
class PieceReader {
  public:
    PieceReader(const YamlValue& map, const Abilities& can) : map_(map), can_(can) {}

    Piece read(const Piece* before) {
        map_.allow_only({"constant_V", "constant_mm", "ramp_V", "ramp_mm", "sine_V", "sine_mm", "offset_V",
                         "offset_mm", "frequency_hz", "phase_deg", "hold", "duration_s"});
        const YamlValue what = shape_key();
        Piece piece;
        if (shape_ != "hold") piece.follows = unit_ == "mm" ? Follows::setpoint : Follows::voltage;
        piece.duration_s = map_.at("duration_s").number({can_.tick_s, longest_experiment_s});
        if (piece.follows == Follows::setpoint && !can_.no_controller.empty()) what.fail(can_.no_controller);
        if (shape_ == "constant") {
            piece.base = what.number(allowed());
        } else if (shape_ == "ramp") {
            const std::vector<double> ends = what.numbers(2, allowed());
            piece.base = ends[0];
            piece.per_s = (ends[1] - ends[0]) / piece.duration_s;
        } else if (shape_ == "sine") {
            read_sine(what, piece);
        } else {
            (void)what.one_of({"last"});
            if (!before) what.fail("there is no piece before this one whose last value could be held");
            piece.follows = before->follows;
            piece.base = value_at(*before, before->duration_s);
        }
        return piece;
    }

  private:
    /// The one key that says what the piece is.
    YamlValue shape_key() {
        std::optional<YamlValue> found;
        for (const std::string& key : map_.keys()) {
            const std::string shape = key.substr(0, key.find('_'));
            if (shape != "constant" && shape != "ramp" && shape != "sine" && shape != "hold") continue;
            if (found) map_.at(key).fail("a piece is one thing only; it has another such key already");
            found = map_.at(key);
            shape_ = shape;
            unit_ = key.substr(std::min(key.size(), shape.size() + 1));
        }
        if (!found)
            map_.fail(
                "says not what the piece is; one of: constant_V, constant_mm, ramp_V, ramp_mm, sine_V, "
                "sine_mm, hold");
        for (const char* key : {"offset_V", "offset_mm", "frequency_hz", "phase_deg"})
            if (const auto value = map_.find(key);
                value && (shape_ != "sine" ||
                          (std::string_view(key).starts_with("offset") && key != "offset_" + unit_)))
                value->fail(
                    fmt::format("does not belong to {}{}{}", shape_, unit_.empty() ? "" : "_", unit_));
        return *found;
    }

    NumberRange allowed() const {
        return unit_ == "mm" ? NumberRange{can_.low_mm, can_.high_mm} : NumberRange{can_.low_V, can_.high_V};
    }

    void read_sine(const YamlValue& what, Piece& piece) const {
        const auto offset = map_.find("offset_" + unit_);
        piece.amplitude = what.number(positive);
        if (offset) piece.base = offset->number(allowed());
        if (!offset && unit_ == "mm") piece.base = map_.at("offset_mm").number(allowed());
        const YamlValue frequency = map_.at("frequency_hz");
        const double frequency_hz = frequency.number(positive);
        if (frequency_hz * can_.tick_s >= 0.5)
            frequency.fail(fmt::format("must be below half the tick rate, {:g} Hz", 0.5 / can_.tick_s));
        piece.omega_rad_per_s = 2.0 * std::numbers::pi * frequency_hz;
        if (const auto phase = map_.find("phase_deg"))
            piece.phase_rad = phase->number({-360.0, 360.0}) * std::numbers::pi / 180.0;
        const auto [low, high] = extremes(piece);
        const NumberRange range = allowed();
        if (low < range.low - rounding || high > range.high + rounding)
            what.fail(fmt::format("the sine goes from {:.6g} to {:.6g} {}; allowed: {:g} to {:g}", low, high,
                                  unit_, range.low, range.high));
    }

    static constexpr double rounding = 1e-9;

    const YamlValue& map_;
    const Abilities& can_;
    std::string shape_, unit_;
};

std::vector<Piece> read_pieces(const YamlValue& list, const Abilities& can) {
    std::vector<Piece> pieces;
    for (const YamlValue& item : list.items()) {
        Piece piece = PieceReader(item, can).read(pieces.empty() ? nullptr : &pieces.back());
        pieces.push_back(piece);
    }
    if (pieces.empty()) list.fail("must hold one piece at least");
    if (const double whole_s = duration_s(pieces); whole_s > longest_experiment_s)
        list.fail(fmt::format("the pieces last {:g} s together; allowed: at most {:g} s", whole_s,
                              longest_experiment_s));
    return pieces;
}

/// It names the recording.
std::string read_name(const YamlValue& value) {
    const std::string name = value.text();
    const auto is_plain = [](unsigned char letter) {
        return std::isalnum(letter) || letter == '-' || letter == '_' || letter == '.';
    };
    if (name.size() > 60 || !std::ranges::all_of(name, is_plain))
        value.fail("must be a name of letters, digits, -, _ and ., 60 at most");
    return name;
}

void read_macro(const YamlValue& root, const Rig& rig, Experiment& experiment) {
    if (const auto loop = root.find("macro_loop"))
        experiment.macro_loop = loop->one_of({"nonlinear_pd", "benchmark_pid"}) == 0
                                    ? MacroLoop::nonlinear_pd
                                    : MacroLoop::benchmark_pid;
    const auto list = root.find("macro");
    if (!list) return;
    const MacroParameters& macro = rig.macro;
    const bool is_pd = experiment.macro_loop == MacroLoop::nonlinear_pd;
    std::string no_controller;
    if (is_pd ? !macro.pd : !macro.pid)
        no_controller =
            fmt::format("the rig {} has no {}: it cannot follow a setpoint so; voltages are allowed",
                        rig.name, is_pd ? "macro.pd" : "macro.pid");
    const std::vector<Piece> pieces =
        read_pieces(*list, {-macro.command_limit_V, macro.command_limit_V, macro.low_mm, macro.high_mm,
                            rig.tick_s, no_controller});
    experiment.macro_V = course_of(pieces, Follows::voltage);
    experiment.macro_setpoint_mm = course_of(pieces, Follows::setpoint);
    experiment.duration_s = std::max(experiment.duration_s, duration_s(pieces));
}

void read_micro(const YamlValue& root, const Rig& rig, Experiment& experiment) {
    const auto list = root.find("micro");
    if (!list) return;
    if (!rig.micro) list->fail(fmt::format("the rig {} has no micro stage", rig.name));
    const MicroParameters& micro = *rig.micro;
    std::string no_controller;
    if (!micro.pi)
        no_controller = fmt::format(
            "the rig {} has no micro.pi: it cannot follow a setpoint; voltages are allowed", rig.name);
    const std::vector<Piece> pieces = read_pieces(
        *list, {0.0, micro.heater.limit_V, micro.low_mm, micro.high_mm, rig.tick_s, no_controller});
    experiment.micro_V = course_of(pieces, Follows::voltage);
    experiment.micro_setpoint_mm = course_of(pieces, Follows::setpoint);
    experiment.duration_s = std::max(experiment.duration_s, duration_s(pieces));
}

Experiment read_experiment(const YamlValue& root, const Rig& rig) {
    root.allow_only({"name", "carriage_mm", "macro", "macro_loop", "micro"});
    Experiment experiment;
    experiment.kind = read_name(root.at("name"));
    experiment.carriage_mm = root.at("carriage_mm").number({rig.macro.low_mm, rig.macro.high_mm});
    read_macro(root, rig, experiment);
    read_micro(root, rig, experiment);
    if (experiment.duration_s == 0.0) root.fail("neither macro nor micro is given: one of them must be");
    return experiment;
}

}  // namespace

Experiment load_experiment(const std::filesystem::path& file, const Rig& rig) {
    return read_experiment(YamlValue::load(file), rig);
}

Experiment parse_experiment(const std::string& text, const std::filesystem::path& file, const Rig& rig) {
    return read_experiment(YamlValue::parse(text, file), rig);
}

bool is_experiment_file(const std::string& argument) {
    const std::filesystem::path file(argument);
    if (file.extension() == ".yaml" || file.extension() == ".yml") return true;
    std::error_code ignored;
    return argument != "campaign" && std::ranges::count(experiment_kinds(), argument) == 0 &&
           std::filesystem::is_regular_file(file, ignored);
}

}  // namespace fidservo
