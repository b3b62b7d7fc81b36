// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/links/hall_smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fidservo::gap {

namespace {

/// Factor of the standard deviation by noise alone, for the deviations from a straight line that the rule
/// admits.
constexpr double bias_share = 1.25;

/// Cumulative sums of values, from which straight lines can be fitted to any rows.
class LineFits {
  public:
    explicit LineFits(const std::vector<double>& values)
        : sums_(values.size() + 1), moments_(values.size() + 1) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            sums_[i + 1] = sums_[i] + values[i];
            moments_[i + 1] = moments_[i] + static_cast<double>(i) * values[i];
        }
    }

    /// The value at row `at` of the line fitted to the rows from `first` up to, not including, `end`.
    double line(std::size_t at, std::size_t first, std::size_t end) const {
        const double count = static_cast<double>(end - first);
        const double centre = 0.5 * static_cast<double>(first + end - 1);
        const double mean = (sums_[end] - sums_[first]) / count;
        const double moment = moments_[end] - moments_[first] - centre * (sums_[end] - sums_[first]);
        return mean + moment / spread(count) * (static_cast<double>(at) - centre);
    }

    /// Variance of line(), relative to the variance of a single value.
    static double variance(std::size_t at, std::size_t first, std::size_t end) {
        const double count = static_cast<double>(end - first);
        const double off = static_cast<double>(at) - 0.5 * static_cast<double>(first + end - 1);
        return 1.0 / count + off * off / spread(count);
    }

  private:
    /// Mathematics: the sum of squared distances of so many neighbouring rows from their middle.
    static double spread(double count) { return count * (count * count - 1.0) / 12.0; }

    std::vector<double> sums_, moments_;
};

/// Stretches of rows with readings, one a tick.
std::vector<Stretch> pieces_of(const PlatformRun& run) {
    std::vector<Stretch> pieces;
    bool open = false;
    for (std::size_t k = 0; k < run.hall_adc.size(); ++k) {
        const bool usable = std::isfinite(run.hall_adc[k]);
        if (usable && !open) pieces.push_back({k, k});
        if (usable) pieces.back().end = k + 1;
        open = usable && run.ticks[k] == 1;
    }
    std::erase_if(pieces, [](const Stretch& piece) { return piece.rows() <= 2; });
    return pieces;
}

/// The rows up to `half` rows away, as far as they exist.
Stretch stretch_around(std::size_t at, std::size_t half, std::size_t rows) {
    return {at < half ? 0 : at - half, std::min(rows, at + half + 1)};
}

/// Index of the half width that the rule chooses.
std::size_t width_at(const LineFits& fits, std::size_t at, std::size_t rows, double floor_lsb) {
    double low = -std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = 0; i < half_widths.size(); ++i) {
        const Stretch fitted = stretch_around(at, half_widths[i], rows);
        const double fit = fits.line(at, fitted.first, fitted.end);
        const double reach = floor_lsb * std::sqrt(LineFits::variance(at, fitted.first, fitted.end));
        low = std::max(low, fit - reach);
        high = std::min(high, fit + reach);
        if (low > high) return i == 0 ? 0 : i - 1;
    }
    return half_widths.size() - 1;
}

/// Medians over 17 rows, since noise alone makes the rule choose too small a width in places.
std::vector<std::size_t> medians(const std::vector<std::size_t>& widths) {
    constexpr std::size_t reach = 8;
    std::vector<std::size_t> found(widths.size());
    std::array<std::size_t, half_widths.size()> counts{};
    for (std::size_t next = 0, i = 0; i < widths.size(); ++i) {
        for (; next < std::min(widths.size(), i + reach + 1); ++next) ++counts[widths[next]];
        if (i > reach) --counts[widths[i - reach - 1]];
        const std::size_t half = (next - (i < reach ? 0 : i - reach) + 1) / 2;
        std::size_t below = 0;
        while ((below += counts[found[i]]) < half) ++found[i];
    }
    return found;
}

void smooth(const PlatformRun& run, const Stretch& piece, const PlatformPrediction& model,
            double command_limit_V, SmoothedReading& found) {
    const std::vector<double>& path_lsb = model.path_lsb;
    const std::size_t rows = piece.rows();
    std::vector<double> residual(rows), drive(rows);
    for (std::size_t i = 0; i < rows; ++i) {
        const std::size_t k = piece.first + i;
        residual[i] = run.hall_adc[k] - path_lsb[k];
        drive[i] = k == 0 ? 0.0 : std::clamp(run.macro_command_V[k - 1], -command_limit_V, command_limit_V);
    }
    const LineFits residual_fits(residual), drive_fits(drive);
    std::vector<std::size_t> widths(rows);
    for (std::size_t i = 0; i < rows; ++i) widths[i] = width_at(residual_fits, i, rows, run.floor_lsb);
    const std::vector<std::size_t> steady = medians(widths);
    for (std::size_t i = 0; i < rows; ++i) {
        const std::size_t k = piece.first + i;
        const Stretch fitted = stretch_around(i, half_widths[steady[i]], rows);
        found.model_lsb[k] = path_lsb[k];
        found.reading_lsb[k] = path_lsb[k] + residual_fits.line(i, fitted.first, fitted.end);
        found.std_lsb[k] =
            bias_share * run.floor_lsb * std::sqrt(LineFits::variance(i, fitted.first, fitted.end));
        found.readings[k] = static_cast<double>(fitted.rows());
        found.drive_V[k] = drive_fits.line(i, fitted.first, fitted.end);
    }
}

/// Takes over the model's bends between the rows of a piece.
void keep_bends(const Stretch& piece, const PlatformPrediction& model, SmoothedReading& found) {
    const std::size_t each = model.bends_lsb.size() / model.path_lsb.size();
    const auto at = [&](std::size_t row) { return static_cast<std::ptrdiff_t>(each * row); };
    std::copy(model.bends_lsb.begin() + at(piece.first), model.bends_lsb.begin() + at(piece.end - 1),
              found.model_bends_lsb.begin() + at(piece.first));
}

/// Gives rows without a value that of the row before, and the first rows the first known value.
void hold(std::vector<double>& values, double none) {
    const auto known = std::ranges::find_if(values, [](double value) { return std::isfinite(value); });
    double last = known == values.end() ? none : *known;
    for (double& value : values) {
        if (std::isfinite(value)) last = value;
        value = last;
    }
}

}  // namespace

SmoothedReading smoothed_reading(const PlatformRun& run, const PlatformPrediction& model,
                                 double command_limit_V) {
    const std::vector<double> none(run.hall_adc.size(), std::numeric_limits<double>::quiet_NaN());
    SmoothedReading found{none, none, std::vector(model.bends_lsb.size(), 0.0), none, none, none, {}};
    for (const Stretch& piece : pieces_of(run)) {
        smooth(run, piece, model, command_limit_V, found);
        keep_bends(piece, model, found);
    }
    hold(found.reading_lsb, 0.0);
    hold(found.model_lsb, 0.0);
    hold(found.std_lsb, run.floor_lsb);
    hold(found.readings, 1.0);
    hold(found.drive_V, 0.0);
    return found;
}

double changed_lsb(const SmoothedReading& reading, std::size_t from, std::size_t to) {
    const double m = reading.readings[from], n = reading.readings[to];
    const double apart = to > from ? static_cast<double>(to - from) : static_cast<double>(from - to);
    const double common = std::clamp(0.5 * (m + n) - apart, 0.0, std::min(m, n));
    const double noise_lsb = reading.std_lsb[from] * std::sqrt(m);
    return noise_lsb * std::sqrt(1.0 / m + 1.0 / n - 2.0 * common / (m * n));
}

}  // namespace fidservo::gap
