// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The difference between the true force on a carriage and the force in its prediction, from the prediction's
// errors, without another simulation.
//
// Prediction and truth obey tau dv/dt + v = K f, dy/dt = v with forces f in V that differ. Multiply the
// difference of the two equations by a modulating function phi, which vanishes with its derivatives at the
// ends of a short support, and integrate by parts: the error e = prediction - reading, mm, gives the mean
// difference of the forces over the support,
//
//     int phi (f_predicted - f) dt = int (tau phi'' - phi') e dt / K,
//
// with no derivative of a reading and no state at the support's start (Shinbrot 1957; "weak form"). The
// result is local: if a carriage was predicted to stop but moved on, the position is wrong for the rest of
// the window, the force only at the place of the predicted stop. Supports in which the carriage stands are
// left out, as friction balances any force there.
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

    /// The mean of f_predicted - f over each support, weighted by phi, in units of its standard deviation,
    /// which follows from the readings' noise floor.
    const Errors& lacking() const { return lacking_; }

    /// Evidence::windows(), with the range of each window's supports in lacking() instead of that of its
    /// rows; it may be empty.
    const std::vector<Window>& windows() const { return windows_; }

    /// The values that lacking() would have if prediction and recording differed by a given force in V, which
    /// acts in the prediction only.
    Column of_force(int group, const std::function<double(const SlidingRow&)>& force_V) const;

    /// The values that lacking() would have if prediction and recording differed by a given error of the
    /// reading in mm, which the prediction has only.
    Column of_reading(int group, const std::function<double(const SlidingRow&)>& error_mm) const;

    /// The mean velocity, mm/s, and acceleration, mm/s^2, over each support, divided by the standard
    /// deviation of lacking(); from unsmoothed positions by integration by parts.
    Column mean_velocity(const std::function<double(const SlidingRow&)>& position_mm) const {
        return column(0, of_velocity_, position_mm);
    }
    Column mean_acceleration(const std::function<double(const SlidingRow&)>& position_mm) const {
        return column(0, of_acceleration_, position_mm);
    }

    /// The standard deviation, caused by the readings' noise floor, of the force (V_per_mm_per_s2 mean
    /// acceleration + V_per_mm_per_s mean velocity), relative to that with the rig file's factors.
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

/// For each support, the weight 1 / sqrt(n + sum of squares of `values`), both over the n supports of its
/// window. This weights windows as the loss in gap/fit/score.h does.
/// @param windows  of CarriageForces::windows()
/// @param values  one for each support
std::vector<double> support_weights(std::span<const Window> windows, const Errors& values);

}  // namespace fidservo::gap
