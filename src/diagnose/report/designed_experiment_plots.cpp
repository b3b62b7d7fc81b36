// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/report/designed_experiment_plots.h"

#include "core/parallel.h"
#include "core/rig.h"
#include "core/time.h"
#include "gap/fit/score.h"
#include "src/design/discrimination.h"
#include "src/diagnose/words.h"
#include "src/report/html.h"
#include "src/report/plot.h"
#include "src/simulation/simulate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

constexpr float absent = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint64_t shown_noise = 1;
constexpr std::string_view plot_group = "designed-experiment";
constexpr int adjusting_iterations = 4;
/// Every so many rows one is drawn: 10 ms apart on a rig of 1 kHz.
constexpr std::size_t drawn_every = 10;

std::string name_in_plots(const design::Explanation& explanation) {
    return explanation.name == "equation" ? "with the equation" : readable(explanation.name);
}

template <typename Value>
std::vector<float> drawn_of(const Recording& recording, std::size_t points, const Value& value) {
    std::vector<float> values(points, absent);
    for (std::size_t k = 0; k < points && k * drawn_every < recording.rows.size(); ++k)
        values[k] = static_cast<float>(value(recording.rows[k * drawn_every]));
    return values;
}

bool has_values(const std::vector<float>& values) {
    return std::ranges::any_of(values, [](float value) { return std::isfinite(value); });
}

/// One of an experiment's duels as the report shows it.
struct ShownDuel {
    gap::Signal signal;
    double log_odds;
    std::vector<float> truth, rival;  ///< r.m.s. of the window that a drawn time is in, floors
};

std::vector<float> window_course(const gap::Evidence& evidence, gap::Signal signal,
                                 const std::vector<double>& squares, const std::vector<double>& time_s) {
    std::vector<float> course(time_s.size(), absent);
    const TimeNs begin_ns = evidence.recordings().front().rows.front().time_ns;
    const double tick_s = evidence.rig().tick_s;
    for (std::size_t w = 0; w < squares.size(); ++w) {
        const gap::Window& window = evidence.windows()[w];
        if (window.signal != signal || !std::isfinite(squares[w])) continue;
        const double from_s = seconds(window.start_ns - begin_ns);
        const double to_s = from_s + static_cast<double>(window.rows) * tick_s;
        for (std::size_t k = 0; k < time_s.size(); ++k)
            if (time_s[k] >= from_s && time_s[k] < to_s)
                course[k] = static_cast<float>(std::sqrt(squares[w]));
    }
    return course;
}

/// The signal in which the rival's windows lose most.
gap::Signal telling_signal(std::span<const gap::Window> windows, const std::vector<double>& truth,
                           const std::vector<double>& rival) {
    std::array<double, gap::signal_count> lost{};
    for (std::size_t w = 0; w < windows.size(); ++w)
        if (std::isfinite(truth[w]) && std::isfinite(rival[w]))
            lost[gap::index_of(windows[w].signal)] += gap::window_loss(rival[w]) - gap::window_loss(truth[w]);
    return static_cast<gap::Signal>(std::ranges::max_element(lost) - lost.begin());
}

/// By that draw of the truth which brings the odds nearest to their mean.
ShownDuel shown_duel(const Rig& rig, const DesignedNext& next, const Experiment& experiment,
                     std::size_t which, const std::vector<double>& time_s) {
    const design::Duel duel = next.question.duels[which];
    const design::Explanation& truth = next.question.explanations[duel.truth];
    const design::Explanation& rival = next.question.explanations[duel.rival];
    const double mean = next.candidate.judgement.log_odds[which];
    ShownDuel shown{};
    double nearest = std::numeric_limits<double>::infinity();
    for (const gap::Hypothesis& hypothesis : truth.draws) {
        const gap::Evidence evidence(rig,
                                     {simulate(rig, hypothesis, experiment, experiment.kind, shown_noise)});
        const gap::Wanted wanted = gap::everything(evidence);
        const gap::Hypothesis adjusted = design::adjusted_to(evidence, rival, adjusting_iterations);
        const auto squares_of = [&](const gap::Hypothesis& of) {
            return gap::mean_squares(evidence.windows(), evidence.errors(of, wanted));
        };
        const std::vector<double> truth_squares = squares_of(hypothesis),
                                  rival_squares = squares_of(adjusted);
        const double log_odds = gap::total_loss(rival_squares) - gap::total_loss(truth_squares);
        if (!(std::abs(log_odds - mean) < nearest)) continue;
        nearest = std::abs(log_odds - mean);
        const gap::Signal signal = telling_signal(evidence.windows(), truth_squares, rival_squares);
        shown = {signal, log_odds, window_course(evidence, signal, truth_squares, time_s),
                 window_course(evidence, signal, rival_squares, time_s)};
    }
    return shown;
}

class Plots {
  public:
    explicit Plots(std::size_t points) : points_(points) {}

    void add(std::string_view part, const std::string& title, std::string_view unit,
             std::vector<report::Trace> traces) {
        constexpr int height_px = 200;
        std::erase_if(traces, [](const report::Trace& trace) { return !has_values(trace.values); });
        if (traces.empty()) return;
        all.push_back({fmt::format("{}-{}", plot_group, part), title, std::string(unit),
                       std::string(plot_group), height_px, std::move(traces)});
    }

    /// A value of the rows as each explanation predicts it.
    template <typename Value>
    void add_predicted(std::string_view part, const std::string& title, std::string_view unit, int digits,
                       const std::vector<Recording>& recordings, const DesignedNext& next,
                       const Value& value) {
        std::vector<report::Trace> traces;
        for (std::size_t k = 0; k < recordings.size(); ++k)
            traces.push_back({name_in_plots(next.question.explanations[k]),
                              drawn_of(recordings[k], points_, value), false, digits, false});
        add(part, title, unit, std::move(traces));
    }

    void add_setpoint(std::string_view part, const std::string& title, double StageRow::*setpoint,
                      const Recording& recording) {
        add(part, title, "mm",
            {{"setpoint", drawn_of(recording, points_, [&](const StageRow& row) { return row.*setpoint; }),
              true, 3, false}});
    }

    std::vector<report::TimePlot> all;

  private:
    std::size_t points_;
};

}  // namespace

std::string designed_experiment_html(const Rig& rig, const DesignedNext& next) {
    const Experiment experiment = design::experiment_of(next.candidate.design, next.name, rig);
    const std::vector<design::Explanation>& explanations = next.question.explanations;
    std::vector<Recording> recordings(explanations.size());
    parallel_for(recordings.size(), [&](std::size_t k) {
        recordings[k] = simulate(rig, explanations[k].hypothesis, experiment, next.name, shown_noise);
    });
    report::TimeAxis axis;
    for (std::size_t row = 0; row < recordings.front().rows.size(); row += drawn_every)
        axis.time_s.push_back(static_cast<double>(row) * rig.tick_s);
    const std::size_t points = axis.time_s.size();
    Plots plots(points);
    if (!next.candidate.design.macro.empty()) {
        plots.add_setpoint("macro-setpoint", "Setpoint of the carriage", &StageRow::macro_setpoint_mm,
                           recordings.front());
        plots.add_predicted("macro", "Motor command, by each explanation", "V", 2, recordings, next,
                            [](const StageRow& row) { return row.macro_command_V; });
        plots.add_predicted(
            "encoder", "Encoder reading that each explanation predicts", "mm", 3, recordings, next,
            [&](const StageRow& row) { return row.encoder_count * rig.macro.encoder_resolution_mm; });
    }
    if (!next.candidate.design.micro.empty()) {
        plots.add_setpoint("micro-setpoint", "Setpoint of the platform", &StageRow::micro_setpoint_mm,
                           recordings.front());
        plots.add_predicted("micro", "Heater command, by each explanation", "V", 2, recordings, next,
                            [](const StageRow& row) { return row.micro_command_V; });
        plots.add_predicted("hall", "Hall reading that each explanation predicts", "adc", 1, recordings, next,
                            [](const StageRow& row) { return row.hall_adc; });
    }
    std::vector<ShownDuel> duels(next.question.duels.size());
    parallel_for(duels.size(),
                 [&](std::size_t k) { duels[k] = shown_duel(rig, next, experiment, k, axis.time_s); });
    for (std::size_t k = 0; k < duels.size(); ++k) {
        const std::string truth = name_in_plots(explanations[next.question.duels[k].truth]),
                          rival = name_in_plots(explanations[next.question.duels[k].rival]);
        plots.add(fmt::format("duel-{}", k),
                  fmt::format("If it is {}: r.m.s. error in the {}, each second; odds of {}", truth,
                              signal_words(duels[k].signal), odds_words(duels[k].log_odds)),
                  "floors",
                  {{rival + ", adjusted", duels[k].rival, true, 2, false},
                   {truth, duels[k].truth, true, 2, false}});
    }
    return fmt::format(
               "<p>{}</p>\n<p class=\"remark\">All from the simulator. A rival is adjusted to what the "
               "experiment would record as far as the recordings so far leave it free; what it is still off "
               "by "
               "beyond one floor is what tells it apart. Values that are only known roughly are drawn anew "
               "for each curve: the odds are the mean over them.</p>\n",
               report::escaped(proposal_of(next).text)) +
           report::time_plots(axis, plots.all);
}

}  // namespace fidservo::diagnose
