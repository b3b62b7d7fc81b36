// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The force that the prediction of a carriage lacks, from the prediction's errors, without simulating the
// carriage again.
//
// Prediction and truth obey tau dv/dt + v = K f, dy/dt = v with forces f in V that differ. Times a modulating
// function phi that vanishes with its derivatives at the ends of a short support, integrated by parts, the
// error e = prediction - reading gives the mean difference of the forces there,
//
//     int phi (f_predicted - f) dt = int (tau phi'' - phi') e dt / K,
//
// with no derivative of a reading and no state at the support's start (Shinbrot 1957; "weak form"). The
// result is local: where a carriage was predicted to stop and moved on, the position is wrong for the rest of
// a window, but a force is lacking only where the carriage moved on. Supports in which the carriage stands
// are left out, as friction balances any force there.
#include "gap/evidence.h"
#include "gap/fit/regression.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace fidservo::gap {

/// A row of a recording in which the carriage slides, with quantities from the readings.
struct SlidingRow {
    double reading_mm;                                              ///< unsmoothed
    double position_mm, velocity_mm_per_s, acceleration_mm_per_s2;  ///< smoothed
    double direction;  ///< of the motion: +1 to the right, -1 to the left
    double command_V;
    double passed;  ///< fraction of an additional force that the dead zone passes: dV/du
    double time_s;  ///< from the recording's first row
    std::size_t run, row;
};

/// Rows to either side of a support's middle. The long support is about as long as a carriage's time
/// constant; the short one is for forces that change faster.
inline constexpr std::size_t short_half_support = 12, long_half_support = 25;

/// Commands nearer to the edge of the dead zone than this, in V, are not used by default: an error of a tenth
/// of a volt may put them on the wrong side.
inline constexpr double usual_edge_V = 0.15;

class CarriageForces {
  public:
    /// @param errors  of a hypothesis; windows of the encoder that are not NaN are used
    /// @param half_support  rows to either side of a support's middle: long supports detect weaker forces,
    /// short ones forces that change faster
    /// @param edge_V  commands that are nearer to the dead zone's edge than this are left out
    CarriageForces(const Evidence& evidence, const Errors& errors, std::size_t half_support,
                   double edge_V = usual_edge_V);

    /// The mean force that is lacking in each support, over its standard deviation from the readings' noise
    /// floor.
    const Errors& lacking() const { return lacking_; }

    /// For each of Evidence::windows(), the window with the range of its supports, which may be empty, in
    /// place of that of its rows.
    const std::vector<Window>& windows() const { return windows_; }

    /// The same as lacking() for a given force in V, which the prediction has and the recording lacks.
    Column of_force(int group, const std::function<double(const SlidingRow&)>& force_V) const;

    /// The same for a given error of the reading, mm, which the prediction has and the recording lacks.
    Column of_reading(int group, const std::function<double(const SlidingRow&)>& error_mm) const;

    /// The mean velocity and acceleration of each support, in mm/s and mm/s^2 over the same standard
    /// deviation, from unsmoothed positions by integration by parts.
    Column mean_velocity(const std::function<double(const SlidingRow&)>& position_mm) const {
        return column(0, of_velocity_, position_mm);
    }
    Column mean_acceleration(const std::function<double(const SlidingRow&)>& position_mm) const {
        return column(0, of_acceleration_, position_mm);
    }

    /// The standard deviation of a force that is the sum of mean acceleration and velocity times these
    /// factors, from the readings' noise floor, relative to that with the rig file's factors.
    double deviation_of(double V_per_mm_per_s2, double V_per_mm_per_s) const;

    /// The values of a quantity in all rows.
    std::vector<float> values(const std::function<double(const SlidingRow&)>& quantity) const;

    /// For each support, the index in rows() of its first row.
    const std::vector<std::size_t>& supports() const { return supports_; }
    const std::vector<SlidingRow>& rows() const { return rows_; }
    /// The weights with which a support's rows enter.
    const std::vector<double>& force_weights() const { return of_force_; }
    const std::vector<double>& reading_weights() const { return of_reading_; }

  private:
    void find_weights(const Rig& rig, double floor_mm, std::size_t half_support);
    Column column(int group, const std::vector<double>& weights,
                  const std::function<double(const SlidingRow&)>& quantity) const;

    std::shared_ptr<const Budget> budget_;
    /// A support's weights, row by row, for a force in V and for a reading in mm.
    std::vector<double> of_force_, of_reading_;
    std::vector<double> of_velocity_, of_acceleration_;  ///< weights for a reading in mm
    std::vector<SlidingRow> rows_;       ///< rows of all sliding stretches, one after the other
    std::vector<std::size_t> supports_;  ///< indices of their first rows
    std::vector<Window> windows_;
    Errors lacking_;
};

/// For each support, 1 / sqrt(n + sum of squares) over the n supports of its window, which weights windows as
/// in gap/fit/score.h.
/// @param windows  of CarriageForces::windows()
/// @param values  one for each support
std::vector<double> support_weights(std::span<const Window> windows, const Errors& values);

}  // namespace fidservo::gap
