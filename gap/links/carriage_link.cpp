// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/carriage_link.h"

#include "gap/links/carriage_start.h"
#include "gap/numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace fidservo::gap {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const plant::MacroAxis& axis_of(const CarriageModel& model, const CarriageRun& run) {
    return run.is_homed ? model.axis : model.endless_axis;
}

/// Whether nothing moves. Bristles and belts never quite come to rest, but swing by less than a thousandth of
/// a count.
bool is_at_rest(const plant::MacroAxis& axis, const plant::MacroAxisState& state) {
    constexpr double rest_mm_per_s = 1e-4;
    const plant::MechanismState& mechanism = state.mechanism;
    const double driven_mm_per_s =
        axis.parameters.play_mm > 0.0 ? mechanism.driven_mm_per_s : state.velocity_mm_per_s;
    return std::max({std::abs(state.velocity_mm_per_s), std::abs(driven_mm_per_s),
                     std::abs(mechanism.stretching_mm_per_s)}) <= rest_mm_per_s;
}

/// Simulates the plant over some rows. Its motion at row k, or only its position, is stored at index k -
/// origin.
/// @return the cost, in rows
std::size_t run_rows(const CarriageModel& model, const CarriageRun& run, std::size_t first, std::size_t end,
                     plant::MacroAxisState& state, CarriagePath& motion, std::size_t origin = 0) {
    // Costs relative to a row in closed form, by their times (bench/gap_bench.cpp).
    constexpr std::size_t of_step = 20, of_belt_step = 25, of_series_step = 14, of_rippled_row = 2;
    const plant::MacroAxis& axis = axis_of(model, run);
    // Otherwise delayed commands may still arrive, or forces change with time.
    const bool may_rest = axis.parameters.delay_s == 0.0 && !axis.parameters.formulas.any();
    const bool only_places = motion.velocity_mm_per_s.empty();
    bool was_at_rest = false, rests = false;
    plant::StepCount steps;
    for (std::size_t k = first; k < end; ++k) {
        const double before_mm = state.position_mm, before_mm_per_s = state.velocity_mm_per_s;
        motion.position_mm[k - origin] = before_mm;
        if (!rests || run.command_V[k] != run.command_V[k - 1])
            steps += plant::advance(axis, state, run.command_V[k]);
        const bool is_now = is_at_rest(axis, state);
        rests = may_rest && is_now && was_at_rest;
        was_at_rest = is_now;
        if (only_places) continue;
        motion.velocity_mm_per_s[k - origin] = before_mm_per_s;
        const plant::Shaking shaking = plant::shaking_of(state.position_mm - before_mm, before_mm_per_s,
                                                         state.velocity_mm_per_s, run.tick_s);
        motion.acceleration_mm_per_s2[k - origin] = shaking.acceleration_mm_per_s2;
        motion.jerk_mm_per_s3[k - origin] = shaking.jerk_mm_per_s3;
    }
    return (end - first) * (model.encoder.is_straight() ? 1 : of_rippled_row) +
           static_cast<std::size_t>(steps.integrated) * (axis.has_belt ? of_belt_step : of_step) +
           static_cast<std::size_t>(steps.in_series) * of_series_step;
}

/// The state in which a stretch begins, before its counts correct it: at the first count; at rest, or with
/// the velocity of the first counts; with what the mechanism remembers of the motion before.
plant::MacroAxisState first_state(const CarriageModel& model, const CarriageRun& run, std::size_t row) {
    const std::size_t glance = std::min(glance_rows, lead_rows(run.tick_s));
    auto state = plant::start(model.axis, position_mm(model.encoder, run.reading_count[row]));
    const double way_mm = position_mm(model.encoder, run.reading_count[row + glance]) - state.position_mm;
    if (std::abs(way_mm) > most_steps_apart * model.encoder.resolution_mm)
        state.velocity_mm_per_s = way_mm / (static_cast<double>(glance) * run.tick_s);
    state.mechanism = remembered(run.way, model.axis, model.encoder.resolution_mm, row);
    state.mechanism.driven_mm_per_s = state.velocity_mm_per_s;
    if (model.axis.parameters.formulas.any()) {
        state.formulas.time_s = run.time_s[row];
        state.formulas.way_mm = model.encoder.resolution_mm * covered_count(run.way, row);
    }
    if (row > 0) state.delay.acting = state.delay.given = run.command_V[row];
    return state;
}

/// The rows before a window, simulated from a state that their counts correct.
class Lead {
  public:
    Lead(const CarriageModel& model, const CarriageRun& run, Followed followed)
        : model_(model),
          run_(run),
          motion_(unknown_path(lead_rows(run.tick_s), followed)),
          trial_(motion_),
          errors_(motion_.position_mm.size()),
          slopes_(errors_.size()) {}

    /// Simulates from the carried state. At the start of a recording, where this does not reproduce the
    /// counts, also simulates from rest and from other positions in the first count: with a force along the
    /// rail these decide which way the carriage goes.
    /// @param is_carried  whether the state is one that the window before led to, not one that was guessed
    /// @return the state at the window's first row
    plant::MacroAxisState enter(const WindowRows& window, const plant::MacroAxisState& carried,
                                bool is_carried) {
        constexpr double enough = 1.0;
        constexpr std::array places_count{-0.2, 0.2, -0.4, 0.4};
        Way best = corrected(window, carried);
        if (!is_carried && !is_linear() && best.loss > enough)
            best = corrected_by_trials(window, carried, best);
        if (window.lead > 0 || is_linear() || best.loss <= enough) return best.end;
        CarriagePath path = motion_;
        const auto try_from = [&](const plant::MacroAxisState& other) {
            const Way way = corrected(window, other);
            if (way.loss >= best.loss) return false;
            best = way;
            path = motion_;
            return true;
        };
        plant::MacroAxisState at_rest = carried;
        at_rest.velocity_mm_per_s = at_rest.mechanism.driven_mm_per_s = 0.0;
        const plant::MacroAxisState& from = try_from(at_rest) ? at_rest : carried;
        for (const double beside_count : places_count) {
            plant::MacroAxisState beside = from;
            beside.position_mm += beside_count * mm_per_count(model_.encoder, carried.position_mm);
            try_from(beside);
        }
        motion_ = std::move(path);
        return best.end;
    }

    const CarriagePath& motion() const { return motion_; }
    std::size_t effort() const { return effort_; }

  private:
    struct Way {
        plant::MacroAxisState end;
        double loss;
        StartCorrection done;
    };

    /// A correction that changes less ends them.
    static constexpr double enough_count = 0.01;

    bool is_linear() const {
        const plant::MacroAxis& axis = model_.axis;
        return axis.has_closed_form && !axis.parameters.formulas.any() && model_.encoder.is_straight();
    }

    Way corrected(const WindowRows& window, const plant::MacroAxisState& carried) {
        constexpr int most_corrections = 3;
        const double ticks_per_tau = model_.axis.parameters.time_constant_s / run_.tick_s;
        StartCorrection done;
        Way way{play(window, carried, done, motion_), std::numeric_limits<double>::infinity(), done};
        for (int round = 0; round < most_corrections; ++round) {
            const StartCorrection better = estimate_start(errors_, done, ticks_per_tau);
            if (round == 0) way.loss = start_loss(errors_, done);
            const double change =
                std::hypot(better.place_count - done.place_count, better.coast_count - done.coast_count);
            if (change < enough_count && round > 0) break;
            const auto trial_end = play(window, carried, better, trial_);
            const double trial_loss = is_linear() ? 0.0 : start_loss(errors_, better);
            if (trial_loss > way.loss) break;
            way = {trial_end, trial_loss, better};
            done = better;
            std::swap(motion_, trial_);
            if (is_linear()) break;
        }
        return way;
    }

    /// Goes on from a correction, now with how the errors change with it by trial: where friction depends on
    /// the speed an error of the velocity does not just decay. It grows where friction falls, so that a speed
    /// that was guessed too large leads to another motion altogether.
    Way corrected_by_trials(const WindowRows& window, const plant::MacroAxisState& carried, Way way) {
        constexpr int most_rounds = 6, most_halvings = 5;
        constexpr double trial_count = 0.02;
        for (int round = 0; round < most_rounds; ++round) {
            (void)play(window, carried, way.done, motion_);
            const std::vector<double> errors = errors_;
            const auto changed = [&](double place_count, double coast_count, double StartSlope::*slope) {
                (void)play(window, carried,
                           {way.done.place_count + place_count, way.done.coast_count + coast_count}, trial_);
                for (std::size_t i = 0; i < errors.size(); ++i)
                    slopes_[i].*slope = (errors_[i] - errors[i]) / trial_count;
            };
            changed(trial_count, 0.0, &StartSlope::per_place);
            changed(0.0, trial_count, &StartSlope::per_coast);
            const StartCorrection best = estimate_start(errors, way.done, slopes_);
            StartCorrection change{best.place_count - way.done.place_count,
                                   best.coast_count - way.done.coast_count};
            bool improves = false;
            for (int halving = 0; halving <= most_halvings && !improves; ++halving) {
                const StartCorrection tried{way.done.place_count + change.place_count,
                                            way.done.coast_count + change.coast_count};
                const auto end = play(window, carried, tried, trial_);
                const double loss = start_loss(errors_, tried);
                improves = loss < way.loss;
                if (improves) {
                    way = {end, loss, tried};
                    std::swap(motion_, trial_);
                } else {
                    change = {0.5 * change.place_count, 0.5 * change.coast_count};
                }
            }
            if (!improves || std::hypot(change.place_count, change.coast_count) < enough_count) break;
        }
        return way;
    }

    plant::MacroAxisState play(const WindowRows& window, const plant::MacroAxisState& carried,
                               const StartCorrection& correction, CarriagePath& motion) {
        const double scale_mm = mm_per_count(model_.encoder, carried.position_mm);
        const double extra_mm_per_s =
            scale_mm * correction.coast_count / model_.axis.parameters.time_constant_s;
        plant::MacroAxisState state = carried;
        state.position_mm += scale_mm * correction.place_count;
        state.velocity_mm_per_s += extra_mm_per_s;
        state.mechanism.driven_mm_per_s += extra_mm_per_s;
        effort_ += run_rows(model_, run_, window.lead, window.first, state, motion, window.lead);
        for (std::size_t i = 0; i < errors_.size(); ++i)
            errors_[i] = mean_reading_count(model_.encoder, motion.position_mm[i]) -
                         run_.reading_count[window.lead + i];
        return state;
    }

    const CarriageModel& model_;
    const CarriageRun& run_;
    CarriagePath motion_, trial_;
    std::vector<double> errors_;
    std::vector<StartSlope> slopes_;
    std::size_t effort_ = 0;  ///< cost so far, in rows
};

/// A run's window, and how the carriage comes to it.
struct Passage {
    WindowRows window;
    std::size_t stretch;
    bool ends_stretch;
    /// Whether the window before leads to it; through an end of travel only where the mechanism remembers its
    /// motion.
    bool follows;
};

std::vector<Passage> passages(const plant::MacroAxis& axis, const CarriageRun& run) {
    std::vector<Passage> all;
    for (std::size_t stretch = 0; stretch < run.windows.size(); ++stretch) {
        const std::vector<WindowRows>& windows = run.windows[stretch];
        const bool runs_on = stretch > 0 && run.is_homed && remembers(axis) &&
                             run.run_on_end[stretch - 1] == windows.front().lead;
        for (std::size_t i = 0; i < windows.size(); ++i)
            all.push_back({windows[i], stretch, i + 1 == windows.size(), i > 0 || runs_on});
    }
    return all;
}

/// The windows to simulate: those wanted; those before them, back to where the counts tell what the mechanism
/// remembers; with a belt also one before each wanted one, in which the belt's swing dies down.
/// @param wanted  a flag for each window; empty: all
std::vector<bool> needed_windows(const CarriageModel& model, const CarriageRun& run,
                                 std::span<const Passage> all, std::span<const std::uint8_t> wanted) {
    std::vector<bool> needed(all.size(), true);
    if (wanted.empty()) return needed;
    const plant::MacroAxis& axis = model.axis;
    bool swings_into_next = false, next_asks = false;
    for (std::size_t k = all.size(); k-- > 0;) {
        needed[k] = wanted[k] != 0 || swings_into_next || next_asks;
        swings_into_next = axis.has_belt && wanted[k] != 0 && all[k].follows;
        next_asks = needed[k] && all[k].follows &&
                    !is_remembered(run.way, axis, model.encoder.resolution_mm, all[k].window.lead);
    }
    return needed;
}

/// @param wanted  a flag for each window; empty: all
PredictedCounts simulate(const CarriageModel& model, const CarriageRun& run,
                         std::span<const std::uint8_t> wanted, CarriagePath* path) {
    const std::size_t rows = run.command_V.size();
    PredictedCounts predicted{std::vector<double>(rows, nan)};
    const Followed followed = path ? Followed::motion : Followed::places;
    CarriagePath motion = unknown_path(rows, followed);
    Lead lead(model, run, followed);
    const std::vector<Passage> all = passages(model.axis, run);
    const std::vector<bool> needed = needed_windows(model, run, all, wanted);
    plant::MacroAxisState carried, state;
    bool is_carried = false;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const auto& [window, stretch, ends_stretch, follows] = all[k];
        if (run.budget) run.budget->check();
        if (!needed[k]) {
            is_carried = false;
            continue;
        }
        const bool is_known = is_carried && follows;
        if (!is_known) carried = first_state(model, run, window.lead);
        is_carried = true;
        state = lead.enter(window, carried, is_known);
        state.position_mm += model.start_offset_count * mm_per_count(model.encoder, state.position_mm);
        const std::size_t next_lead = ends_stretch ? window.end : all[k + 1].window.lead;
        predicted.effort += run_rows(model, run, window.first, next_lead, state, motion);
        carried = state;
        predicted.effort += run_rows(model, run, next_lead, window.end, state, motion);
        for (std::size_t row = window.first; row < window.end; ++row)
            predicted.counts[row] = mean_reading_count(model.encoder, motion.position_mm[row]);
        if (path) {
            CarriagePath before = lead.motion();
            pull_to_counts(model.encoder, run, window, before, motion);
            fade_in(window, before, motion);
        }
        const bool leads_on = k + 1 < all.size() && all[k + 1].follows && needed[k + 1];
        if (ends_stretch && (path || leads_on)) {
            predicted.effort += run_rows(model, run, window.end, run.run_on_end[stretch], state, motion);
            carried = state;
        }
    }
    predicted.effort += lead.effort();
    if (!path || rows == 0) return predicted;
    fill(model.encoder, run, motion);
    *path = std::move(motion);
    return predicted;
}

}  // namespace

CarriageModel carriage_model(const plant::PlantParameters& parameters) {
    plant::MacroAxisParameters endless = parameters.axis;
    endless.low_mm = -std::numeric_limits<double>::infinity();
    endless.high_mm = std::numeric_limits<double>::infinity();
    return {plant::make_macro_axis(parameters.axis, parameters.tick_s),
            plant::make_macro_axis(endless, parameters.tick_s), parameters.encoder};
}

PredictedCounts predicted_counts(const CarriageModel& model, const CarriageRun& run,
                                 std::span<const std::uint8_t> wanted) {
    return simulate(model, run, wanted, nullptr);
}

PredictedCounts predicted_counts(const CarriageModel& model, const CarriageRun& run, CarriagePath& path) {
    return simulate(model, run, {}, &path);
}

}  // namespace fidservo::gap
