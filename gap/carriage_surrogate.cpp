#include "gap/hat_functions.h"
#include "gap/period_search.h"
#include "gap/surrogate.h"
#include "plant/dead_zone.h"

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace fidservo::gap {
namespace {

/// The nominal carriage's answer to forces.
struct Answer {
    double decay, speed_per_V, tick_s;

    explicit Answer(const Rig& rig)
        : decay(rig.macro.velocity_pole),
          speed_per_V(rig.macro.velocity_gain_mm_per_s_per_V),
          tick_s(rig.tick_s) {}
};

/// By how much commands may be late.
constexpr std::array<std::size_t, 2> late_ticks{2, 8};

/// What a row offers to the functions below.
struct Row {
    double velocity_mm_per_s, position_mm, command_V, acceleration_mm_per_s2, time_s;
    std::array<double, late_ticks.size()> late_V;  ///< what the command would do more if it came late
    double direction;                              ///< -1, 0, 1
};

class Columns {
  public:
    explicit Columns(const Evidence& evidence) : evidence_(evidence), answer_(evidence.rig()) {
        for (const Window& window : evidence.windows())
            if (window.signal == Signal::encoder) size_ = std::max(size_, window.end);
        for (const Recording& recording : evidence.recordings()) {
            std::vector<double>& of_run = effective_V_.emplace_back();
            of_run.reserve(recording.rows.size());
            for (const StageRow& row : recording.rows) of_run.push_back(effective_V(row));
        }
        per_count_ = 1.0 / evidence.rig().macro.encoder_resolution_mm / evidence.floor(Signal::encoder);
    }

    Row row(const Window& window, std::size_t k) const {
        const Course& course = evidence_.course(window.run);
        const Recording& recording = evidence_.recordings()[window.run];
        const std::vector<double>& effective_V = effective_V_[window.run];
        const double v = course.velocity_mm_per_s[k];
        const double before = course.velocity_mm_per_s[k > 0 ? k - 1 : 0];
        Row row{v,
                course.position_mm[k],
                recording.rows[k].macro_command_V,
                (v - before) / answer_.tick_s,
                seconds(recording.rows[k].time_ns - recording.rows.front().time_ns),
                {},
                std::abs(v) < moving_mm_per_s ? 0.0 : std::copysign(1.0, v)};
        for (std::size_t i = 0; i < late_ticks.size(); ++i)
            row.late_V[i] = effective_V[k >= late_ticks[i] ? k - late_ticks[i] : 0] - effective_V[k];
        return row;
    }

    /// What a force adds to the reading; it acts on a carriage that moves.
    Column of_force(Dependence group, const std::function<double(const Row&)>& force_V) const {
        return over_windows(group, [&](const Window& window, std::vector<float>& values) {
            double velocity = 0.0, way = 0.0;
            for (std::size_t k = 0; k < window.rows; ++k) {
                values[window.begin + k] = static_cast<float>(way * per_count_);
                const Row at = row(window, window.first_row + k);
                const double force = at.direction == 0.0 ? 0.0 : force_V(at);
                velocity = at.direction == 0.0
                               ? 0.0
                               : answer_.decay * velocity + (1.0 - answer_.decay) * answer_.speed_per_V *
                                                                (std::isfinite(force) ? force : 0.0);
                way += velocity * answer_.tick_s;
            }
        });
    }

    /// What a false reading adds, mm.
    Column of_reading(Dependence group, const std::function<double(const Row&)>& error_mm) const {
        return over_windows(group, [&](const Window& window, std::vector<float>& values) {
            for (std::size_t k = 0; k < window.rows; ++k)
                values[window.begin + k] =
                    static_cast<float>(error_mm(row(window, window.first_row + k)) * per_count_);
        });
    }

    /// What a velocity at a window's start adds.
    Column of_start_velocity() const {
        return over_windows(Dependence::velocity, [&](const Window& window, std::vector<float>& values) {
            double velocity = 1.0, way = 0.0;
            for (std::size_t k = 0; k < window.rows; ++k) {
                values[window.begin + k] = static_cast<float>(way);
                velocity *= answer_.decay;
                way += velocity;
            }
        });
    }

    Column of_start_position() const {
        return over_windows(Dependence::position, [&](const Window& window, std::vector<float>& values) {
            for (std::size_t k = 0; k < window.rows; ++k) values[window.begin + k] = 1.0F;
        });
    }

    /// All values of a quantity while the carriage moves.
    std::vector<float> moving(const std::function<double(const Row&)>& quantity) const {
        std::vector<float> values;
        constexpr std::size_t every = 7;
        for (const Window& window : evidence_.windows()) {
            if (window.signal != Signal::encoder) continue;
            for (std::size_t k = 0; k < window.rows; k += every) {
                const Row at = row(window, window.first_row + k);
                if (at.direction != 0.0) values.push_back(static_cast<float>(quantity(at)));
            }
        }
        return values;
    }

  private:
    /// Of a command, what the file's friction leaves.
    double effective_V(const StageRow& row) const {
        const DeadZone& zone = evidence_.rig().macro.dead_zone;
        return plant::dead_zone_V(zone, plant::dead_zone_branch(zone, row.macro_command_V),
                                  row.macro_command_V);
    }

    Column over_windows(Dependence group,
                        const std::function<void(const Window&, std::vector<float>&)>& fill) const {
        Column column{static_cast<int>(group), std::vector<float>(size_, 0.0F)};
        for (const Window& window : evidence_.windows())
            if (window.signal == Signal::encoder) fill(window, column.values);
        return column;
    }

    const Evidence& evidence_;
    Answer answer_;
    std::size_t size_ = 0;
    std::vector<std::vector<double>> effective_V_;  ///< of each recording's rows
    double per_count_ = 0.0;
};

void add_hats(std::vector<Column>& columns, const Columns& make, Dependence group, std::size_t knots_count,
              const std::function<double(const Row&)>& quantity) {
    const std::vector<double> knots = knots_by_share(make.moving(quantity), knots_count);
    if (knots.size() < 2) return;
    for (std::size_t k = 0; k < knots.size(); ++k)
        columns.push_back(
            make.of_force(group, [&, k](const Row& at) { return hat(knots, k, quantity(at)); }));
}

/// A force may be a sine; graduations err in harmonics too.
std::vector<Column> waves(const Columns& make, double period_mm) {
    std::vector<Column> columns;
    for (const double phase : {0.0, 0.5 * std::numbers::pi}) {
        const auto wave = [=](double waves_in_period) {
            const double per_mm = 2.0 * std::numbers::pi * waves_in_period / period_mm;
            return [=](const Row& at) { return std::sin(per_mm * at.position_mm + phase); };
        };
        columns.push_back(make.of_force(Dependence::position_period, wave(1.0)));
        columns.push_back(make.of_reading(Dependence::reading_period, wave(1.0)));
        columns.push_back(make.of_reading(Dependence::reading_period, wave(2.0)));
    }
    return columns;
}

}  // namespace

Surrogate carriage_surrogate(const Evidence& evidence, const Errors& errors) {
    const Columns make(evidence);
    Surrogate surrogate{Signal::encoder, {}, {make.of_start_position(), make.of_start_velocity()}};
    std::vector<Column>& columns = surrogate.columns;
    add_hats(columns, make, Dependence::velocity, 12, [](const Row& at) { return at.velocity_mm_per_s; });
    columns.push_back(make.of_force(Dependence::direction, [](const Row& at) { return at.direction; }));
    columns.push_back(make.of_force(Dependence::nothing, [](const Row&) { return 1.0; }));
    add_hats(columns, make, Dependence::position, 16, [](const Row& at) { return at.position_mm; });
    const std::vector<double> places =
        knots_by_share(make.moving([](const Row& at) { return at.position_mm; }), 16);
    for (std::size_t k = 0; places.size() > 1 && k < places.size(); ++k)
        columns.push_back(make.of_force(Dependence::position_friction, [&, k](const Row& at) {
            return at.direction * hat(places, k, at.position_mm);
        }));
    columns.push_back(make.of_force(Dependence::acceleration,
                                    [](const Row& at) { return 1e-3 * at.acceleration_mm_per_s2; }));
    columns.push_back(make.of_reading(Dependence::acceleration,
                                      [](const Row& at) { return 1e-5 * at.acceleration_mm_per_s2; }));
    add_hats(columns, make, Dependence::command, 8, [](const Row& at) { return at.command_V; });
    for (std::size_t i = 0; i < late_ticks.size(); ++i)
        columns.push_back(
            make.of_force(Dependence::command_change, [i](const Row& at) { return at.late_V[i]; }));
    add_hats(columns, make, Dependence::time, 6, [](const Row& at) { return at.time_s; });
    const auto periods = strongest_periods(evidence, errors, everything(evidence));
    if (!periods.empty()) surrogate.period_mm = periods.front().period_mm;
    if (surrogate.period_mm > 0.0)
        for (Column& wave : waves(make, surrogate.period_mm)) columns.push_back(std::move(wave));
    return surrogate;
}

}  // namespace fidservo::gap
