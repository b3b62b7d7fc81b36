// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/report/dependence_charts.h"

#include "src/diagnose/words.h"
#include "src/report/html.h"
#include "src/report/svg_axes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace fidservo::diagnose {
namespace {

using gap::Signal;
using report::ChartArea;
using report::escaped;
using report::Scale;

constexpr std::size_t bins = 30;
constexpr ChartArea area{
    .left = 62.0, .right = 548.0, .top = 12.0, .bottom = 206.0, .width = 560.0, .height = 252.0};
constexpr double band_errors = 2.0;  ///< half width of a band in standard errors

/// The unit of a chart's errors, per floor.
struct ErrorUnit {
    std::string_view unit;
    double per_floor;
};

ErrorUnit error_unit(const gap::Evidence& evidence, const gap::SignalGap& signal) {
    if (signal.signal == Signal::tag) return {"floors", 1.0};
    const DisplayUnit display = display_unit(evidence.rig(), signal.signal, signal.before);
    return {display.unit, display.per_own_unit * evidence.floor(signal.signal)};
}

/// What a chart has to show, in floors: the floor and all means with their bands. A band that is much wider
/// than all means is cut off.
struct Reach {
    double low = -1.25, high = 1.25;

    void include(const BinnedMean& mean) {
        constexpr double most_per_mean = 1.6;
        double largest = 0.0;
        for (const double value : mean.mean)
            if (!std::isnan(value)) largest = std::max(largest, std::abs(value));
        const auto limited = [&](double value) {
            return std::clamp(value, -most_per_mean * largest, most_per_mean * largest);
        };
        for (std::size_t bin = 0; bin < mean.mean.size(); ++bin) {
            if (std::isnan(mean.mean[bin])) continue;
            const double band = std::isnan(mean.std_error[bin]) ? 0.0 : band_errors * mean.std_error[bin];
            low = std::min(low, limited(mean.mean[bin] - band));
            high = std::max(high, limited(mean.mean[bin] + band));
        }
    }
};

/// A line with its band; gaps where there is no mean.
std::string curve_svg(const std::vector<double>& middles, const BinnedMean& mean, double per_floor,
                      const Scale& x, const Scale& y, int part) {
    const auto within = [&](double value) { return y(std::clamp(value, y.from, y.to)); };
    std::string line, dots, bands;
    std::string upper, lower;
    bool pen_down = false;
    const auto close_band = [&] {
        if (!upper.empty()) bands += fmt::format("<path class=\"band\" d=\"M{}L{}Z\"/>", upper, lower);
        upper.clear();
        lower.clear();
    };
    for (std::size_t bin = 0; bin < middles.size(); ++bin) {
        if (std::isnan(mean.mean[bin])) {
            pen_down = false;
            close_band();
            continue;
        }
        const double at = x(middles[bin]), value = per_floor * mean.mean[bin];
        line += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", at, within(value));
        dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\"/>", at, within(value));
        pen_down = true;
        if (std::isnan(mean.std_error[bin])) {
            close_band();
            continue;
        }
        const double half = per_floor * band_errors * mean.std_error[bin];
        upper += fmt::format("{}{:.1f} {:.1f}", upper.empty() ? "" : "L", at, within(value + half));
        lower = fmt::format("{:.1f} {:.1f}{}{}", at, within(value - half), lower.empty() ? "" : "L", lower);
    }
    close_band();
    return fmt::format("<g class=\"curve part-{}\">{}<path d=\"{}\"/>{}</g>", part, bands, line, dots);
}

std::string chart_svg(const Quantity& quantity, const BinnedErrors& errors, const ErrorUnit& unit,
                      bool is_explained) {
    constexpr double margin = 0.04;
    Reach reach;
    reach.include(errors.before);
    if (is_explained) reach.include(errors.after);
    const double spare = margin * (reach.high - reach.low);
    const double half_bin = 0.5 * (errors.x[1] - errors.x[0]);
    const Scale x{errors.x.front() - half_bin, errors.x.back() + half_bin, area.left, area.right},
        y{unit.per_floor * (reach.low - spare), unit.per_floor * (reach.high + spare), area.bottom, area.top};
    std::string svg = report::svg_opening(area, "Mean error over " + quantity.axis_label);
    svg += fmt::format("<rect class=\"floor-band\" x=\"{}\" y=\"{:.1f}\" width=\"{}\" height=\"{:.1f}\"/>",
                       area.left, y(unit.per_floor), area.right - area.left,
                       y(-unit.per_floor) - y(unit.per_floor));
    svg += report::svg_y_axis(area, y, fmt::format("mean error, {}", unit.unit));
    svg += curve_svg(errors.x, errors.before, unit.per_floor, x, y, 0);
    if (is_explained) svg += curve_svg(errors.x, errors.after, unit.per_floor, x, y, 1);
    return svg + report::svg_x_axis(area, x, quantity.axis_label) + "</svg>\n";
}

/// Whether a diagnosis says that what remains of this signal depends on this.
bool is_named(const gap::Diagnosis& diagnosis, Signal signal, const Quantity& quantity) {
    if (!diagnosis.unexplained || !diagnosis.unexplained->text.starts_with(gap::name_of(signal)))
        return false;
    return std::ranges::any_of(diagnosis.unexplained->depends_on, [&](const std::string& name) {
        return name == quantity.name || (name.starts_with("position, ") && quantity.name == "position") ||
               (name == "direction" && quantity.name == "velocity");
    });
}

std::string figure_html(const gap::Diagnosis& diagnosis, Signal signal, const Quantity& quantity,
                        const BinnedErrors& errors, const ErrorUnit& unit, bool is_explained) {
    std::string caption =
        fmt::format("The mean accounts for {} of the squared error before", share_words(errors.before.share));
    if (is_explained) caption += fmt::format(", for {} after", share_words(errors.after.share));
    const bool named = is_named(diagnosis, signal, quantity);
    return fmt::format("<figure class=\"dependence{}\">{}<figcaption>{}.{}</figcaption></figure>\n",
                       named ? " named" : "", chart_svg(quantity, errors, unit, is_explained),
                       escaped(caption),
                       named ? " <strong>The unexplained remainder depends on this.</strong>" : "");
}

}  // namespace

std::string dependence_html(const gap::Evidence& evidence, const gap::Diagnosis& diagnosis,
                            const Predictions& predictions) {
    std::string html;
    std::vector<std::string> quiet;
    for (const gap::SignalGap& signal : diagnosis.signals) {
        const std::vector<Quantity> all = quantities(evidence, predictions, signal.signal);
        if (all.empty()) continue;
        const std::string name(signal_words(signal.signal));
        if (size_class(std::max(signal.before, signal.after) / signal.floor) == 0) {
            quiet.push_back("the " + name);
            continue;
        }
        html += fmt::format("<h3>Error of the {}{}</h3>\n<div class=\"dependences\">\n", name,
                            signal.signal == Signal::tag ? " along the motion" : "");
        for (const Quantity& quantity : all)
            html += figure_html(diagnosis, signal.signal, quantity, binned(quantity.samples, bins),
                                error_unit(evidence, signal), predictions.is_explained);
        html += "</div>\n";
    }
    if (!html.empty()) {
        std::vector<std::string> names{"rig file as it is"};
        if (predictions.is_explained) names.emplace_back("with the explanation");
        html = report::chart_legend(names) +
               "<p class=\"remark\">Mean of predicted minus recorded in 30 bins; the coloured bands are two "
               "standard errors wide to each side, from how the 1 s windows scatter; the grey band is the "
               "noise floor of a single reading.</p>\n" +
               html;
    }
    if (!quiet.empty())
        html += fmt::format("<p>Not drawn, because at the noise floor: {}.</p>\n", enumerated(quiet));
    return html;
}

}  // namespace fidservo::diagnose
