// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The parts of the heater's fit: its parameters in comparable units, the residuals of runs, their least
// squares, and each reading's influence.
#include "calib/batch_variance.h"
#include "calib/wire/heater_fit.h"

#include <cmath>
#include <functional>
#include <optional>

#include <Eigen/Core>

namespace fidservo::calib {

inline constexpr int heater_count = static_cast<int>(heater_numbers);
inline constexpr std::size_t least_heater_rows = 50;

using HeaterVector = Eigen::Matrix<double, heater_count, 1>;
using HeaterPredict = std::function<std::vector<double>(const HeaterParameters&, const HeaterRun&)>;

using HeaterFree = std::array<bool, heater_numbers>;

/// The scaling of the parameters x, relative to a start value, in units in which a standard error of one is
/// useless: a fifth of gain and of time constants, a twentieth of the commands' range, 1 degC.
struct HeaterScale {
    HeaterParameters start;
    double command_range;
    /// Whether the heater is fitted without a rig file. The onset is then at least the start value's, the
    /// third parameter is the ratio of heating tau to cooling tau, and gain and cooling tau cannot be held
    /// fixed, since no values for them are known.
    bool by_itself = false;

    HeaterParameters at(const double* x) const {
        constexpr double fifth = 0.2, twentieth = 0.05, ambient_degC = 1.0;
        HeaterParameters heater = start;
        heater.onset_V += twentieth * command_range * x[0];
        heater.gain_degC_per_V *= std::exp(fifth * x[1]);
        heater.heating_tau_s *= std::exp(fifth * (by_itself ? x[2] + x[3] : x[2]));
        heater.cooling_tau_s *= std::exp(fifth * x[3]);
        heater.ambient_degC += ambient_degC * x[4];
        return heater;
    }
};

double number_of(const HeaterParameters& heater, int i);

/// Weighted residuals of all runs, every stride-th row; rows without weight are left out.
class HeaterResiduals {
  public:
    HeaterResiduals(const std::vector<HeaterRun>& runs, const HeaterPredict& predict,
                    const HeaterScale& scale)
        : runs_(runs), predict_(predict), scale_(scale) {
        std::size_t all = 0;
        for (const HeaterRun& run : runs) all += run.reading.size();
        constexpr std::size_t most_rows = 40'000;
        stride_ = 1 + all / most_rows;
        for (const HeaterRun& run : runs)
            for (std::size_t k = 0; k < run.reading.size(); k += stride_) count_ += weight(run, k) > 0.0;
    }

    int count() const { return count_; }

    /// A function of x that is held near a value by an additional residual, the last one.
    struct Pin {
        std::function<double(const HeaterVector&)> figure;
        double value, std;
    };
    void pin(Pin pin) {
        count_ += pin_ ? 0 : 1;
        pin_ = std::move(pin);
    }

    bool operator()(double const* const* blocks, double* residual) const {
        const HeaterParameters heater = scale_.at(blocks[0]);
        int next = 0;
        for (const HeaterRun& run : runs_) {
            const std::vector<double> model = predict_(heater, run);
            for (std::size_t k = 0; k < run.reading.size(); k += stride_)
                if (const double w = weight(run, k); w > 0.0)
                    residual[next++] = w * (model[k] - run.reading[k]);
        }
        if (pin_)
            residual[next++] =
                (pin_->figure(Eigen::Map<const HeaterVector>(blocks[0])) - pin_->value) / pin_->std;
        return std::all_of(residual, residual + next, [](double r) { return std::isfinite(r); });
    }

    Eigen::VectorXd at(const HeaterVector& x) const {
        Eigen::VectorXd residual(count_);
        const double* block = x.data();
        (*this)(&block, residual.data());
        return residual;
    }

    /// The number of residuals of each run, in the runs' order.
    std::vector<int> run_counts() const {
        std::vector<int> counts;
        for (const HeaterRun& run : runs_) {
            counts.push_back(0);
            for (std::size_t k = 0; k < run.reading.size(); k += stride_)
                counts.back() += weight(run, k) > 0.0;
        }
        return counts;
    }

    /// Weighted sum of squares of the readings about their weighted mean.
    double variation() const {
        double sum = 0.0, first = 0.0, second = 0.0;
        for (const HeaterRun& run : runs_)
            for (std::size_t k = 0; k < run.reading.size(); k += stride_) {
                const double w = weight(run, k) * weight(run, k);
                sum += w;
                first += w * run.reading[k];
                second += w * run.reading[k] * run.reading[k];
            }
        return sum > 0.0 ? std::max(0.0, second - first * first / sum) : 0.0;
    }

    double weight_squares() const {
        double sum = 0.0;
        for (const HeaterRun& run : runs_)
            for (std::size_t k = 0; k < run.reading.size(); k += stride_)
                sum += weight(run, k) * weight(run, k);
        return sum;
    }

  private:
    static double weight(const HeaterRun& run, std::size_t k) {
        return run.weight.empty() ? 1.0 : run.weight[k];
    }

    const std::vector<HeaterRun>& runs_;
    const HeaterPredict& predict_;
    const HeaterScale& scale_;
    std::size_t stride_ = 1;
    int count_ = 0;
    std::optional<Pin> pin_ = {};
};

/// Least squares over the free parameters.
/// @return false if it did not converge to a usable solution
bool solve_heater(const HeaterResiduals& residuals, const HeaterFree& is_free, bool onset_bounded,
                  HeaterVector& x);

/// The influence of each reading on x, a column per reading; rows of fixed parameters are 0.
struct HeaterInfluences {
    Eigen::Matrix<double, heater_count, Eigen::Dynamic> readings;
    Eigen::Matrix<double, heater_count, heater_count> claimed;  ///< covariance of x for independent errors
    std::vector<int> run_counts;
    std::size_t fitted = 0;
};

HeaterInfluences influences_at(const HeaterResiduals& residuals, const HeaterFree& is_free,
                               const HeaterVector& x);

/// Variance of a quantity with this gradient by x, from batches of readings (calib/batch_variance.h), but no
/// less than for independent errors.
BatchVariance variance_along(const HeaterInfluences& influences, const HeaterVector& gradient);

/// Standard errors of x.
HeaterVector parameter_stds(const HeaterInfluences& influences);

/// Derivative of a parameter in physical units by x.
HeaterVector gradient_of(const HeaterScale& scale, const HeaterVector& x, int number);

}  // namespace fidservo::calib
