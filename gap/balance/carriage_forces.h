// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The force that a carriage's prediction lacks, from its errors, without following the carriage.
//
// Prediction and truth obey tau dv/dt + v = K f, dy/dt = v with forces f in V that differ. Times a modulating
// function phi that vanishes with its derivatives at the ends of a short support, integrated by parts, the
// error e = prediction - reading gives the mean difference of the forces there,
//
//     int phi (f_predicted - f) dt = int (tau phi'' - phi') e dt / K,
//
// with no derivative of a reading and no state at the support's start (Shinbrot 1957; "weak form"). It is
// local: a carriage that was predicted to stand and went on is off for the rest of a window, but lacks a
// force only where friction let it go. Supports in which the carriage stands are left out: friction answers
// any force there.
#include "gap/evidence.h"
#include "gap/fit/regression.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace fidservo::gap {

/// What is known of a row of a recording in which the carriage slides, from the readings.
struct SlidingRow {
    double reading_mm;                                              ///< as it is
    double position_mm, velocity_mm_per_s, acceleration_mm_per_s2;  ///< smoothed
    double direction;                                               ///< -1 or 1
    double command_V;
    double passed;  ///< share of a force beside the command that the dead zone lets through: dV/du
    double time_s;  ///< from the recording's first row
    std::size_t run, row;
};

/// Rows to either side of a support's middle: the long one about a time constant of a carriage, the short one
/// for what changes faster.
inline constexpr std::size_t short_half_support = 12, long_half_support = 25;

/// How near to the edge of the dead zone forces of a tenth of a volt may be misjudged.
inline constexpr double usual_edge_V = 0.15;

class CarriageForces {
  public:
    /// @param errors  of a hypothesis; windows of the encoder that are not NaN are used
    /// @param half_support  rows to either side of a support's middle: long supports see weaker forces, short
    ///                      ones those that change faster
    /// @param edge_V  commands that are nearer to the dead zone's edge than this are left out
    CarriageForces(const Evidence& evidence, const Errors& errors, std::size_t half_support,
                   double edge_V = usual_edge_V);

    /// The mean force that each support lacks, over its standard deviation by the floor of the readings; laid
    /// out like Errors, at the value of the support's middle row, NaN elsewhere.
    const Errors& lacking() const { return lacking_; }

    /// The same for a force in V that the prediction has and the truth lacks.
    Column of_force(int group, const std::function<double(const SlidingRow&)>& force_V) const;

    /// The same for what a prediction of a false reading has in excess, mm.
    Column of_reading(int group, const std::function<double(const SlidingRow&)>& error_mm) const;

    /// The mean velocity and acceleration of each support, in mm/s and mm/s^2 over the same standard
    /// deviation: by parts from the readings as they are.
    Column mean_velocity() const { return column(0, of_velocity_, reading_mm); }
    Column mean_acceleration() const { return column(0, of_acceleration_, reading_mm); }

    /// Of what a mean acceleration and velocity come to, in V per mm/s^2 and per mm/s, by the floor of the
    /// readings, over that by the rig file.
    double deviation_of(double V_per_mm_per_s2, double V_per_mm_per_s) const;

    /// All values of a quantity.
    std::vector<float> values(const std::function<double(const SlidingRow&)>& quantity) const;

    struct Support {
        std::size_t slot;   ///< of its middle in Errors
        std::size_t first;  ///< of its rows in rows()
    };
    const std::vector<Support>& supports() const { return supports_; }
    const std::vector<SlidingRow>& rows() const { return rows_; }
    /// Weights of a support's rows.
    const std::vector<double>& force_weights() const { return of_force_; }
    const std::vector<double>& reading_weights() const { return of_reading_; }

  private:
    void find_weights(const Rig& rig, double floor_mm, std::size_t half_support);
    Column column(int group, const std::vector<double>& weights,
                  const std::function<double(const SlidingRow&)>& quantity) const;

    static double reading_mm(const SlidingRow& row) { return row.reading_mm; }

    std::shared_ptr<const Budget> budget_;
    std::vector<double> of_force_, of_reading_;          ///< a support's weights, row by row, for V and mm
    std::vector<double> of_velocity_, of_acceleration_;  ///< for mm
    std::vector<SlidingRow> rows_;                       ///< of stretches that slide, one after the other
    std::vector<Support> supports_;
    Errors lacking_;
};

/// Of each support, 1 / sqrt(n + sum of squares) over the n supports of its window: windows weighted as in
/// gap/fit/score.h.
/// @param values  at the supports' middles
std::vector<double> support_weights(const Evidence& evidence,
                                    std::span<const CarriageForces::Support> supports, const Errors& values);

}  // namespace fidservo::gap
