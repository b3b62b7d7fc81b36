// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/fod_curves.h"
#include "calib/wire/heater_fit.h"
#include "core/failure.h"
#include "core/input_error.h"
#include "core/result.h"
#include "core/rig.h"
#include "src/identify/identify.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo {

namespace {

struct Source {
    calib::HysteresisTrace trace;
    std::vector<std::string> names;
    std::string input_unit, output_unit;
    bool starts_cold = false;
};

/// A table's own units, but lengths in mm where its input is a temperature: those are the rig file's units.
Source hysteresis_from_table(const TextTable& table) {
    for (const auto& [role, usual] : {std::pair{"input", "degC"}, std::pair{"output", "mm"}})
        demand_no_other_unit(
            table, role, [](const Unit& other) { return other.quantity != "time"; }, usual);
    const TableColumn &input = *table.find("input"), &output = *table.find("output");
    Source source{{input.values, output.values}, {table.file.string()}, input.unit, output.unit};
    if (input.unit == "degC" && !output.unit.empty()) {
        source.trace.output = values_in(table, "output", "mm");
        source.output_unit = "mm";
    }
    return source;
}

/// Whether the platform hardly moved: such a recording costs as much as others and tells nothing.
bool rests(const Recording& recording, const MicroModel& model) {
    constexpr double least_share = 0.05;
    const auto [low, high] = std::ranges::minmax(recording.rows, {}, &StageRow::hall_adc);
    const double moved_mm =
        platform_position_mm(model, high.hall_adc) - platform_position_mm(model, low.hall_adc);
    return !(moved_mm > least_share * model.fod->stroke_mm());
}

/// Recordings hold no wire temperature: it is simulated by the rig file's heater. Each recording starts cold,
/// which wipes the memory of the one before.
Source hysteresis_from_recordings(const IdentifyInput& input) {
    if (!input.rig.micro)
        throw InputError(fmt::format("the rig {} has no micro stage to identify", input.rig.name));
    const MicroModel model = nominal_micro_model(*input.rig.micro);
    Source source{{}, {}, "degC", "mm", true};
    for (const Recording& recording : input.recordings) {
        if (!recording.columns.hall || !recording.columns.micro_command || rests(recording, model)) continue;
        demand_every_tick(recording);
        demand_possible_readings(recording, input.rig.micro->hall);
        calib::HeaterRun run{.tick_s = recording.tick_s, .command = {}, .reading = {}};
        for (const StageRow& row : recording.rows) {
            if (!std::isfinite(row.hall_adc)) continue;
            run.command.push_back(std::isfinite(row.micro_command_V) ? row.micro_command_V : 0.0);
            source.trace.output.push_back(platform_position_mm(model, row.hall_adc));
        }
        const std::vector<double> temp_degC = calib::predict_temperature(model.heater, run);
        source.trace.input.insert(source.trace.input.end(), temp_degC.begin(), temp_degC.end());
        source.names.push_back(recording.name);
    }
    if (source.names.empty())
        throw InputError(
            "no recording has micro_command [V] and a hall [adc] that moves; a table of temperature and "
            "displacement "
            "is read with --table");
    return source;
}

double largest_std(const calib::PreisachFit& fit) {
    double largest = 0.0;
    for (std::size_t k = 0; k < fit.node_std.size(); ++k)
        if (fit.determined[k]) largest = std::max(largest, fit.node_std[k]);
    return largest;
}

void report(const calib::PreisachFit& fit, const Source& source, Identified& identified) {
    const auto determined = std::ranges::count(fit.determined, true);
    const std::string& unit = source.output_unit;
    identified.values = {{"stroke", unit, fit.table.stroke_mm(), fit.node_std.back(), false},
                         {"offset", unit, fit.offset, std::nan(""), false},
                         {"direction", "", fit.direction, std::nan(""), false}};
    const double step = calib::smallest_step(source.trace.output);
    identified.residuals = {{"output", unit, fit.residual_rms, step / std::sqrt(12.0)},
                            {"output_cross_validated", unit, fit.held_out_rms, std::nullopt}};
    identified.notes.push_back(fmt::format(
        "table of {} nodes, {:.4g} to {:.4g} {}; {} samples; density's penalty {:g}; largest standard "
        "error of a determined node {:.3g} {}",
        fit.table.nodes(), fit.table.low_degC(), fit.table.high_degC(), source.input_unit, fit.samples,
        fit.penalty, largest_std(fit), unit));
    if (determined < static_cast<std::ptrdiff_t>(fit.determined.size()))
        identified.undetermined.push_back(
            {"micro.preisach_fod",
             fmt::format(
                 "{} of the table's {} nodes: the input never switched them, or not apart from others; they "
                 "are interpolated",
                 static_cast<std::ptrdiff_t>(fit.determined.size()) - determined, fit.determined.size())});
}

/// How a fit to the first half predicts the second.
void report_halves(const Source& source, const calib::PreisachFitOptions& options, Identified& identified) {
    const std::size_t half = source.trace.input.size() / 2;
    calib::PreisachFitOptions first = options;
    first.last = half;
    if (const auto fit = calib::fit_preisach(source.trace, first))
        identified.residuals.push_back({"output_second_half_from_first", source.output_unit,
                                        calib::prediction_rms(*fit, source.trace, half), std::nullopt});
}

}  // namespace

Identified identify_hysteresis(const IdentifyInput& input) {
    const Source source =
        input.table ? hysteresis_from_table(*input.table) : hysteresis_from_recordings(input);
    Identified identified{.part = "hysteresis", .recordings = source.names};
    constexpr std::size_t wire_nodes = 40, other_nodes = 25;  // a wire transforms within a few degrees
    const calib::PreisachFitOptions options{.nodes = source.input_unit == "degC" ? wire_nodes : other_nodes,
                                            .starts_at_saturation = source.starts_cold};
    std::optional<calib::PreisachFit> fit;
    if (auto fod = source.starts_cold
                       ? Result<calib::FodIdentification>(failure(Reason::not_identifiable, ""))
                       : calib::identify_fod(source.trace, {.nodes = options.nodes})) {
        identified.notes.push_back(
            fmt::format("{} descending curves, peaks {:.4g} to {:.4g} {}; {} cycles of higher order; table "
                        "minus curves {:.3g} "
                        "{} r.m.s.",
                        fod->descending.size(), fod->descending.back().peak, fod->descending.front().peak,
                        source.input_unit, fod->cycles_left_out, fod->readings_rms, source.output_unit));
        fit = std::move(fod->fit);
    } else if (auto any = calib::fit_preisach(source.trace, options)) {
        fit = std::move(*any);
    } else {
        identified.undetermined.push_back({"micro.preisach_fod", any.error().text});
        return identified;
    }
    report(*fit, source, identified);
    if (input.table) report_halves(source, options, identified);
    if (source.input_unit == "degC" && source.output_unit == "mm")
        identified.fod = std::make_shared<const FodTable>(fit->table);
    else
        identified.notes.emplace_back(
            "a rig file takes a table of degC and mm only: state them as the columns' units");
    return identified;
}

}  // namespace fidservo
