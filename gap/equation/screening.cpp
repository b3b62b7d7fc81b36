// SPDX-License-Identifier: GPL-3.0-or-later
#include "gap/equation/screening.h"

#include "core/dead_zone.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/rig.h"
#include "gap/balance/carriage_forces.h"
#include "gap/candidates/coupling.h"
#include "gap/equation/losing.h"
#include "gap/equation/visited.h"
#include "gap/evidence/halves.h"
#include "gap/fit/regression.h"
#include "gap/fit/score.h"
#include "gap/numbers.h"
#include "gap/residuals/surrogate.h"
#include "plant/effects/catalogue.h"
#include "plant/formulas/formula_effect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>

namespace fidservo::gap {

/// The responses of a signal's errors to a port's terms, and the errors that these may explain.
struct PortResponses {
    Signal signal = Signal::encoder;
    std::vector<Column> columns;  ///< group: index of the term; one column for each of its texts, or none
    Errors errors;
    std::vector<Window> windows;  ///< with their ranges among the errors
    /// The coefficient of a term, divided by the factor that the regression gives its column.
    double coefficient_per_factor = -1.0;
};

namespace {

/// One expression of a term as an effect, with a coefficient.
const plant::Effect& effect_of_text(plant::Port port, const Term& term, std::size_t text,
                                    double coefficient) {
    return plant::effect_of(
        formula_of(one_text_of(port, term, text, coefficient), plant::describe(port).blocks.front(), "term"));
}

PortResponses carriage_responses(const Evidence& evidence, const Errors& errors, plant::Port port,
                                 const std::vector<Term>& terms) {
    const CarriageForces forces(evidence, errors, long_half_support);
    const std::vector<std::vector<double>> way_mm = ways_gone_mm(evidence);
    const DeadZone& zone = evidence.rig().macro.dead_zone;
    PortResponses responses;
    responses.errors = forces.lacking();
    responses.windows = forces.windows();
    const bool is_friction = port == plant::Port::friction, is_reading = port == plant::Port::encoder;
    if (is_friction) responses.coefficient_per_factor = 1.0;
    for (std::size_t t = 0; t < terms.size(); ++t)
        for (std::size_t text = 0; text < terms[t].texts.size(); ++text) {
            const plant::EffectSetting one =
                plant::typical_setting(effect_of_text(port, terms[t], text, 1.0));
            const plant::FormulaCode& code = *one.effect->formula;
            std::vector<std::vector<double>> remembering_V;
            if (terms[t].memory)
                for (std::size_t run = 0; run < evidence.recordings().size(); ++run)
                    remembering_V.push_back(values_along(evidence, code, one.values, run));
            const auto value = [&](const SlidingRow& row) {
                if (is_reading) return code.value(std::array{row.position_mm}, {}, one.values);
                if (!remembering_V.empty()) return row.passed * remembering_V[row.run][row.row];
                plant::CarriageFormulaState seen;
                seen.time_s = row.time_s;
                seen.command_V = row.command_V;
                seen.way_mm = way_mm[row.run][row.row];
                const double value_V = code.value(
                    plant::formula_variables(seen, {row.position_mm, row.velocity_mm_per_s, row.direction,
                                                    dead_zone_V(zone, row.command_V)}),
                    {}, one.values);
                return is_friction ? value_V : row.passed * value_V;
            };
            responses.columns.push_back(is_reading ? forces.of_reading(static_cast<int>(t), value)
                                                   : forces.of_force(static_cast<int>(t), value));
        }
    return responses;
}

/// A small value, in a port's unit, of the term whose response is computed. For positions that the camera
/// sees it is several counts: where the encoder's zero is found from tags, the zero can only shift by whole
/// counts.
double a_little_of(plant::Port port, const Rig& rig) {
    constexpr double counts = 4.0, of_power = 0.3, of_transformation = 0.1, of_view = 1e-4, otherwise = 1e-3;
    switch (port) {
        case plant::Port::camera_x:
        case plant::Port::camera_y:
        case plant::Port::tag_x:
        case plant::Port::tag_y:
            return counts * rig.macro.encoder_resolution_mm;
        case plant::Port::heater_power:
        case plant::Port::heat_flow:
            return of_power;
        case plant::Port::transformation:
            return of_transformation;
        case plant::Port::camera_rotation:
        case plant::Port::camera_tilt_u:
        case plant::Port::camera_tilt_v:
        case plant::Port::camera_scale:
        case plant::Port::frame_time:
            return of_view;
        default:
            return otherwise;
    }
}

PortResponses simulated_responses(const Evidence& evidence, const Hypothesis& base, const Errors& errors,
                                  plant::Port port, const std::vector<Term>& terms) {
    PortResponses responses;
    responses.signal = plant::describe(port).site == plant::Site::camera ? Signal::tag : Signal::hall;
    constexpr std::size_t few = 6;
    const Wanted wanted =
        where_most_is_lost(evidence, responses.signal, mean_squares(evidence.windows(), errors), nearly_all,
                           few, evidence.recordings().size());
    responses.errors = errors;
    responses.windows = evidence.windows();
    for (std::size_t w = 0; w < wanted.size(); ++w) {
        const Window& window = evidence.windows()[w];
        if (wanted[w] == 0)
            std::fill(responses.errors.begin() + static_cast<std::ptrdiff_t>(window.begin),
                      responses.errors.begin() + static_cast<std::ptrdiff_t>(window.end),
                      std::numeric_limits<float>::quiet_NaN());
    }
    const Errors before = evidence.errors(base, wanted);
    std::vector<std::vector<Column>> of_terms(terms.size());
    parallel_for(terms.size(), [&](std::size_t t) {
        std::vector<Column>& columns = of_terms[t];
        for (std::size_t text = 0; text < terms[t].texts.size(); ++text) {
            const double coefficient = a_little_of(port, evidence.rig()) / terms[t].size;
            Hypothesis with = base;
            with.push_back(plant::typical_setting(effect_of_text(port, terms[t], text, coefficient)));
            Errors response = evidence.errors(with, wanted);
            if (response.empty()) return columns.clear();
            for (std::size_t i = 0; i < response.size(); ++i)
                response[i] = (response[i] - before[i]) / static_cast<float>(coefficient);
            columns.push_back({static_cast<int>(t), std::move(response)});
        }
    });
    for (std::vector<Column>& columns : of_terms)
        std::ranges::move(columns, std::back_inserter(responses.columns));
    return responses;
}

/// Random halves of the recordings, in complementary pairs; if there are few recordings, of stretches of four
/// windows.
class RandomHalves {
  public:
    static constexpr int count = 20;

    explicit RandomHalves(const Evidence& evidence) : stream_(1, "random halves") {
        constexpr std::size_t enough = 6;
        const bool by_run = evidence.recordings().size() >= enough;
        std::size_t run = 0, windows = 0;
        for (const Window& window : evidence.windows()) {
            if (window.run != run) {
                run = window.run;
                windows = 0;
            }
            constexpr std::size_t most_stretches = 10000;
            piece_.push_back(by_run ? run : run * most_stretches + windows++ / windows_in_stretch);
        }
    }

    /// For each window, whether it belongs to the next half.
    std::vector<std::uint8_t> next() {
        if (is_second_) {
            is_second_ = false;
            for (std::uint8_t& kept : kept_) kept = kept != 0 ? 0 : 1;
            return kept_;
        }
        is_second_ = true;
        std::vector<std::size_t> pieces = piece_;
        std::ranges::sort(pieces);
        pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
        for (std::size_t k = pieces.size(); k > 1; --k)
            std::swap(pieces[k - 1],
                      pieces[std::min(k - 1,
                                      static_cast<std::size_t>(stream_.uniform() * static_cast<double>(k)))]);
        pieces.resize(pieces.size() / 2);
        std::ranges::sort(pieces);
        kept_.clear();
        for (const std::size_t piece : piece_)
            kept_.push_back(std::ranges::binary_search(pieces, piece) ? 1 : 0);
        return kept_;
    }

  private:
    NoiseStream stream_;
    std::vector<std::size_t> piece_;
    std::vector<std::uint8_t> kept_;
    bool is_second_ = false;
};

/// The selected terms, in their order, but one of each family only, and as many as an equation may have.
std::vector<int> admitted(const std::vector<Term>& terms, const std::vector<int>& taken) {
    std::vector<int> kept;
    std::size_t coefficients = 0, shapes = 0;
    for (const int group : taken) {
        const Term& term = terms[static_cast<std::size_t>(group)];
        const auto is_of_family = [&](int other) {
            return terms[static_cast<std::size_t>(other)].family == term.family;
        };
        if (std::ranges::any_of(kept, is_of_family) || coefficients + term.texts.size() > most_coefficients ||
            shapes + term.shapes.size() > most_equation_shapes)
            continue;
        kept.push_back(group);
        coefficients += term.texts.size();
        shapes += term.shapes.size();
    }
    return kept;
}

/// For each selected term, the share of random halves in which its family is selected again and its first
/// factor has the same sign.
std::vector<double> shares_of_halves(const Evidence& evidence, const Regression& regression,
                                     const std::vector<Term>& terms, const std::vector<int>& taken,
                                     double tail) {
    const std::vector<double> whole = regression.factors(taken);
    RandomHalves halves(evidence);
    std::vector<double> shares(taken.size(), 0.0);
    for (int k = 0; k < RandomHalves::count; ++k) {
        const Regression half = regression.restricted_to(halves.next());
        const std::vector<int> found = admitted(terms, half.significant_groups(tail, usually_as_good));
        std::size_t column = 0;
        for (std::size_t i = 0; i < taken.size(); ++i) {
            const Term& term = terms[static_cast<std::size_t>(taken[i])];
            const auto same = std::ranges::find_if(found, [&](int other) {
                return terms[static_cast<std::size_t>(other)].family == term.family;
            });
            if (same != found.end()) {
                const std::vector<double> factors = half.factors(taken);
                if (term.texts.size() > 1 || factors[column] * whole[column] > 0.0)
                    shares[i] += 1.0 / RandomHalves::count;
            }
            column += term.texts.size();
        }
    }
    return shares;
}

}  // namespace

struct PortScreening::Parts {
    const Evidence& evidence;
    plant::Port port;
    std::vector<Term> terms;
    PortResponses responses;
    Regression regression;

    Sketch sketch_of(const std::vector<int>& groups) const {
        Sketch sketch{port, {}, {}};
        for (const int group : groups) sketch.terms.push_back(terms[static_cast<std::size_t>(group)]);
        for (const double factor : regression.factors(groups))
            sketch.coefficients.push_back(responses.coefficient_per_factor * factor);
        return sketch;
    }
};

namespace {

PortResponses responses_of(const Evidence& evidence, const Hypothesis& base, const Errors& errors,
                           plant::Port port, const std::vector<Term>& terms) {
    const plant::Site site = plant::describe(port).site;
    return site == plant::Site::carriage || site == plant::Site::encoder
               ? carriage_responses(evidence, errors, port, terms)
               : simulated_responses(evidence, base, errors, port, terms);
}

}  // namespace

PortScreening::PortScreening(const Evidence& evidence, const Hypothesis& base, const Errors& errors,
                             plant::Port port, std::vector<Term> terms) {
    PortResponses responses = responses_of(evidence, base, errors, port, terms);
    const std::vector<std::uint8_t> half = halves(evidence);
    Regression regression(responses.windows, responses.signal, responses.errors, responses.columns, {}, half);
    parts_ = std::make_unique<Parts>(
        Parts{evidence, port, std::move(terms), std::move(responses), std::move(regression)});
}

PortScreening::~PortScreening() = default;
PortScreening::PortScreening(PortScreening&&) noexcept = default;

std::optional<Sketch> PortScreening::sketch(double tail) const {
    const auto& [evidence, port, terms, responses, regression] = *parts_;
    std::vector<int> taken = admitted(terms, regression.significant_groups(tail, usually_as_good));
    if (taken.empty()) return {};
    const std::vector<double> shares = shares_of_halves(evidence, regression, terms, taken, tail);
    for (std::size_t k = taken.size(); k-- > 0;)
        if (shares[k] < least_share_of_halves) taken.erase(taken.begin() + static_cast<std::ptrdiff_t>(k));
    if (taken.empty()) return {};
    return parts_->sketch_of(taken);
}

std::vector<Sketch> PortScreening::leading(std::size_t count) const {
    const auto& [evidence, port, terms, responses, regression] = *parts_;
    struct TermGain {
        int group;
        double gain;
    };
    std::vector<TermGain> promises;
    const std::vector<double> before = regression.mean_squares({});
    for (std::size_t k = 0; k < responses.columns.size(); ++k) {
        const int group = responses.columns[k].group;
        if (k > 0 && responses.columns[k - 1].group == group) continue;
        const std::array groups{group};
        promises.push_back(
            {group, compare(evidence.windows(), before, regression.mean_squares(groups)).gain});
    }
    std::ranges::sort(promises, std::greater{}, &TermGain::gain);
    std::vector<Sketch> found;
    std::vector<int> families;
    for (const auto& [group, gain] : promises) {
        const int family = terms[static_cast<std::size_t>(group)].family;
        if (found.size() == count || gain <= 0.0) break;
        if (std::ranges::find(families, family) != families.end()) continue;
        families.push_back(family);
        found.push_back(parts_->sketch_of({group}));
    }
    return found;
}

}  // namespace fidservo::gap
