// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/wire/heater_fit.h"
#include "core/failure.h"
#include "core/input_error.h"
#include "core/result.h"
#include "core/rig.h"
#include "src/identify/identify.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

struct Key {
    const char* name;
    const char* unit;
};

constexpr std::array<Key, calib::heater_numbers> keys{
    Key{"micro.heater.onset_V", "V"}, Key{"micro.heater.gain_degC_per_V", "degC/V"},
    Key{"micro.heater.heating_tau_s", "s"}, Key{"micro.heater.cooling_tau_s", "s"},
    Key{"micro.heater.ambient_degC", "degC"}};

/// Whether the platform moved: a recording in which it rested says nothing, and costs as much.
bool moved(const Recording& recording, const MicroModel& model) {
    constexpr double least_share = 0.1;
    double low = INFINITY, high = -INFINITY;
    for (const StageRow& row : recording.rows) {
        const double x_mm = platform_position_mm(model, row.hall_adc);
        low = std::min(low, x_mm);
        high = std::max(high, x_mm);
    }
    return high - low > least_share * model.stroke_scale * model.fod->stroke_mm();
}

calib::HeaterRun run_of(const Recording& recording) {
    calib::HeaterRun run{.tick_s = recording.tick_s, .command = {}, .reading = {}};
    run.command.reserve(recording.rows.size());
    run.reading.reserve(recording.rows.size());
    for (const StageRow& row : recording.rows) {
        run.command.push_back(std::isfinite(row.micro_command_V) ? row.micro_command_V : 0.0);
        run.reading.push_back(row.hall_adc);
    }
    return run;
}

void state(const calib::HeaterFit& fit, const HeaterParameters& heater, Identified& identified, bool volts) {
    const std::array values{heater.onset_V, heater.gain_degC_per_V, heater.heating_tau_s,
                            heater.cooling_tau_s, heater.ambient_degC};
    for (std::size_t i = 0; i < values.size(); ++i) {
        const bool refused = std::ranges::any_of(fit.refused, [&](const calib::HeaterRefusal& r) {
            return static_cast<std::size_t>(r.number) == i;
        });
        if (refused) continue;
        identified.values.push_back({keys[i].name, volts ? keys[i].unit : "", values[i], fit.std[i], volts,
                                     wide_interval(values[i], fit.std[i], fit.freedom[i])});
    }
    for (const calib::HeaterCombination& combination : fit.combinations)
        identified.values.push_back(
            {combination.name, volts ? combination.unit : "", combination.value, combination.std, false});
    if (!fit.combinations.empty())
        identified.notes.emplace_back("of numbers that are not determined each by itself, a combination is");
    for (const calib::HeaterContradiction& found : fit.contradictions)
        identified.contradictions.push_back(
            {keys[static_cast<std::size_t>(found.number)].name,
             found.apart,
             {identified.recordings[found.low], found.low_value, found.low_std},
             {identified.recordings[found.high], found.high_value, found.high_std}});
    for (const calib::HeaterRefusal& refusal : fit.refused)
        identified.undetermined.push_back(
            {keys[static_cast<std::size_t>(refusal.number)].name, refusal.reason});
}

void refuse_all(const Failure& failed, Identified& identified) {
    for (const Key& key : keys) identified.undetermined.push_back({key.name, failed.text});
}

/// The largest share of the signal that a model may miss, r.m.s.: what it misses may be of the shape of what
/// a number does, and a number that is off by more than a fifth is not determined.
constexpr double most_missed_signal = 0.2;

bool misses_too_much(const calib::HeaterFit& fit, Identified& identified) {
    identified.missed_share = fit.missed_share;
    if (fit.missed_share <= most_missed_signal) return false;
    refuse_all({Reason::not_identifiable,
                fmt::format("the model misses {:.2g} % of what the sensor shows", 100.0 * fit.missed_share)},
               identified);
    return true;
}

Identified heater_from_recordings(const IdentifyInput& input) {
    if (!input.rig.micro)
        throw InputError(fmt::format("the rig {} has no micro stage to identify", input.rig.name));
    const MicroModel model = nominal_micro_model(*input.rig.micro);
    Identified identified{.part = "heater"};
    std::vector<calib::HeaterRun> runs;
    std::vector<std::string> resting;
    bool any = false;
    for (const Recording& recording : input.recordings) {
        if (!recording.columns.hall || !recording.columns.micro_command) continue;
        any = true;
        if (!moved(recording, model)) {
            resting.push_back(recording.name);
            continue;
        }
        demand_every_tick(recording);
        demand_possible_readings(recording, input.rig.micro->hall);
        runs.push_back(run_of(recording));
        identified.recordings.push_back(recording.name);
    }
    if (!any) throw InputError("no recording has both micro_command [V] and hall [adc]");
    if (!resting.empty())
        identified.notes.push_back(
            fmt::format("the platform rested, left out: {}", fmt::join(resting, ", ")));
    if (runs.empty()) {
        refuse_all({Reason::not_identifiable, "the platform rested in all recordings"}, identified);
        return identified;
    }
    const auto fit = calib::fit_heater(model, runs);
    if (!fit) {
        refuse_all(fit.error(), identified);
        return identified;
    }
    if (misses_too_much(*fit, identified)) return identified;
    state(*fit, fit->heater, identified, true);
    identified.residuals.push_back(
        {"hall", "adc", fit->residual_rms, std::hypot(model.hall.noise_lsb, 1.0 / std::sqrt(12.0))});
    identified.notes.emplace_back(
        "ambient temperature and a load's shift of the transformation temperatures look the same without a "
        "wire "
        "thermometer");
    return identified;
}

calib::HeaterRun run_of(const IdentifyInput& input, std::size_t& corrupt) {
    const std::vector<double> times_s = table_times_s(input);
    const TextTable& table = *input.table;
    const std::vector<double>& commands = table.find("input")->values;
    const std::vector<std::size_t> bad = calib::corrupt_samples(commands);
    corrupt = bad.size();
    calib::HeaterRun run{.tick_s = times_s.size() < 2 ? 1.0
                                                      : (times_s.back() - times_s.front()) /
                                                            static_cast<double>(times_s.size() - 1),
                         .command = calib::without_samples(commands, bad),
                         .reading = values_in(table, "output", "degC")};
    if (table.find("ambient") != nullptr) run.ambient_degC = values_in(table, "ambient", "degC");
    return run;
}

double rms_between(const calib::HeaterFit& fit, calib::HeaterRun run, std::size_t first, std::size_t last) {
    run.start_degC = run.reading.front();
    const std::vector<double> model = calib::predict_temperature(fit.heater, run);
    double squares = 0.0;
    for (std::size_t k = first; k < last; ++k) squares += std::pow(model[k] - run.reading[k], 2);
    return std::sqrt(squares / static_cast<double>(last - first));
}

/// Fitted to one half of the table, how well is the other predicted from the start on, on the commands alone?
void report_held_out(const calib::HeaterRun& run, Identified& identified) {
    calib::HeaterRun half = run;
    const std::size_t n = run.reading.size();
    half.weight.assign(n, 0.0);
    std::fill_n(half.weight.begin(), n / 2, 1.0);
    if (const auto fit = calib::fit_heater_to_temperature({half}))
        identified.residuals.push_back(
            {"temperature_second_half_from_first", "degC", rms_between(*fit, run, n / 2, n), std::nullopt});
}

Identified heater_from_table(const IdentifyInput& input) {
    Identified identified{.part = "heater", .recordings = {input.table->file.string()}};
    std::size_t corrupt = 0;
    const calib::HeaterRun run = run_of(input, corrupt);
    if (corrupt > 0)
        identified.notes.push_back(fmt::format(
            "{} of {} commands are corrupt (isolated, far from those around) and were replaced by those "
            "before them",
            corrupt, run.command.size()));
    const auto fit = calib::fit_heater_to_temperature({run});
    if (!fit) {
        refuse_all(fit.error(), identified);
        return identified;
    }
    if (misses_too_much(*fit, identified)) return identified;
    const bool volts = input.table->find("input")->unit == "V";
    state(*fit, fit->heater, identified, volts && run.ambient_degC.empty());
    if (!run.ambient_degC.empty())
        identified.notes.emplace_back(
            "ambient_degC is what the thermometer reads above the ambient column when the wire is cold");
    if (std::isnan(fit->std[static_cast<std::size_t>(calib::HeaterNumber::heating_tau)]))
        identified.notes.push_back(
            fmt::format("one time constant for both ways: {:.4g} s", fit->heater.cooling_tau_s));
    identified.residuals.push_back({"temperature", "degC", fit->residual_rms, std::nullopt});
    report_held_out(run, identified);
    return identified;
}

}  // namespace

Identified identify_heater(const IdentifyInput& input) {
    return input.table ? heater_from_table(input) : heater_from_recordings(input);
}

}  // namespace fidservo
