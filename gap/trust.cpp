#include "gap/trust.h"

#include "gap/gap_size.h"
#include "gap/posterior.h"
#include "gap/surrogate.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace fidservo::gap {
namespace {

/// Whether what accuses a block shows in the same way as an effect of another one. The forces that a carriage
/// lacks tell its blocks apart well; of the view, the tags' own size and their places are told from all else.
/// An encoder whose readings the tags contradict, and its own model too, is no matter of the view.
bool could_be(std::string_view named_block, const Remainder& whole) {
    if (whole.block == "macro.encoder" && named_block == "camera.geometry") return true;
    if (whole.depends_on.empty()) return false;
    if (whole.block == "plate")
        return (named_block.starts_with("camera.") || named_block == "macro.encoder") &&
               whole.depends_on.size() == 1;
    return named_block.starts_with("macro.") && whole.block.starts_with("macro.");
}

/// Whether what is named stands in for something else: the gap as a whole depends on what accuses a block
/// that none of the names has.
/// @param least_names  of those that could be it, below which they are believed
bool has_stand_in(const Selection& selection, const Remainder& whole, std::ptrdiff_t least_names) {
    const auto block_of = [](const Choice& choice) {
        return std::string_view(choice.candidate->effect->block);
    };
    return std::ranges::count_if(selection.choices,
                                 [&](const Choice& choice) { return could_be(block_of(choice), whole); }) >=
               least_names &&
           std::ranges::none_of(selection.choices,
                                [&](const Choice& choice) { return block_of(choice) == whole.block; });
}

/// Whether the gap as a whole is friction at a place, and nothing that is named knows places.
bool lacks_place(const Selection& selection, const Remainder& whole) {
    const auto knows_places = [](const Choice& choice) {
        return std::ranges::find(choice.candidate->effect->parameters, "mm", &plant::EffectParameter::unit) !=
               choice.candidate->effect->parameters.end();
    };
    return !whole.depends_on.empty() && whole.depends_on.front() == name_of(Dependence::position_friction) &&
           std::ranges::none_of(selection.choices, knows_places);
}

/// Whether several causes of one stage, or of the camera, were put together. Of 63 such explanations that
/// leave something (eleven self-checks, seeds 2060 to 2094) 8 were right.
bool is_patchwork(const Selection& selection) {
    constexpr std::ptrdiff_t many = 2;
    return std::ranges::any_of(std::array{"macro.", "micro.", "camera."}, [&](std::string_view part) {
        return std::ranges::count_if(selection.choices, [&](const Choice& choice) {
                   return choice.candidate->effect->block.starts_with(part);
               }) >= many;
    });
}

/// Whether a setting has gone as far from what is usual as it may.
bool is_at_a_bound(const plant::EffectSetting& setting) {
    const std::span<const plant::EffectParameter> parameters = setting.effect->parameters;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        const double value = setting.values[k];
        if (value != parameters[k].vanishing && (value == parameters[k].low || value == parameters[k].high))
            return true;
    }
    return false;
}

/// Whether a camera that is turned about an axis far over its own centre is named: it displaces what it sees,
/// as a false reading of the encoder does.
bool is_displacement_by_camera(const Selection& selection) {
    return std::ranges::any_of(selection.steps.back().of_half, [](const Hypothesis& hypothesis) {
        return std::ranges::any_of(hypothesis, [](const plant::EffectSetting& setting) {
            return setting.effect->block == "camera.geometry" && is_at_a_bound(setting);
        });
    });
}

/// On two self-checks of 300 (seeds 2051, 2055) all 48 explanations that leave something and remove less of
/// the gap than this were wrong, of those that remove more 43 of 69.
constexpr double least_removed_by_the_cause = 0.85;

/// What removes more than this is no stand-in: those of the self-checks removed .995 at most.
constexpr double most_removed_by_stand_in = 0.999;

/// What leaves more floors than this has not found the cause, however much it removes: of four self-checks 6
/// of 34 such names were right.
constexpr double most_floors_left = 10.0;

constexpr double trust_in_stand_in = 0.3;

/// What leaves something and removes less than this is as well something else of its kind: bristles called
/// Coulomb friction, drag that grows with the square of speed called viscous. On ten self-checks 28 of 49
/// names that were believed though they left something and removed less than this were wrong or not all, of
/// the 47 that removed more 8. Of names that leave nothing and remove less than the second share 3 of 7 were
/// wrong.
constexpr double removed_by_the_cause = 0.9999, removed_at_the_floor = 0.98, trust_in_its_kind = 0.9;

/// Where nothing is named, what nearly was: an effect that must not be named left nothing, so that it is what
/// the richer ones of its block come to at a limit; or the errors were found to depend on nothing, but one
/// effect predicts them better than any other.
std::string block_of_nameless(const Selection& selection, const Remainder& remainder) {
    const auto is_of_richer = [&](const Candidate* limit) {
        return std::ranges::all_of(selection.alone, [&](const Trial& trial) {
            return !is_limit_of(limit->effect->name, trial.candidate->effect->name) ||
                   trial.candidate->effect->block == limit->effect->block;
        });
    };
    const auto limit = std::ranges::find_if(selection.limits, is_of_richer);
    if (limit != selection.limits.end()) return std::string((*limit)->effect->block);
    if (!remainder.depends_on.empty() || !remainder.block.starts_with("macro.") || selection.alone.empty())
        return remainder.block;
    const Trial& best = *std::ranges::max_element(selection.alone, {}, &Trial::gain);
    const std::string_view block = best.candidate->effect->block;
    return best.gain > least_gain && block.starts_with("macro.") ? std::string(block) : remainder.block;
}

/// Of an explanation that leaves something.
Trust trust_beside(const Evidence& evidence, const Selection& selection, const TotalGap& gap,
                   Remainder remainder, double tail) {
    if (selection.choices.empty()) {
        remainder.block = block_of_nameless(selection, remainder);
        return {0.0, std::move(remainder)};
    }
    double trust = trust_in(typical_floors(evidence.windows(), selection.steps.back().mean_squares));
    const std::optional<Remainder> whole = remainder_of(evidence, selection.steps.front(), tail);
    // A false scale does all that a plate of another pitch does but for the jumps from tag to tag.
    const double most_removed =
        whole && whole->block == "plate" ? removed_by_the_cause : most_removed_by_stand_in;
    const bool stands_in = is_patchwork(selection) || is_displacement_by_camera(selection) ||
                           gap.removed() < least_removed_by_the_cause || gap.after > most_floors_left ||
                           (gap.removed() < most_removed && whole &&
                            (has_stand_in(selection, *whole, 1) || lacks_place(selection, *whole)));
    if (stands_in) trust = std::min(trust, trust_in_stand_in);
    if (gap.removed() < removed_by_the_cause) trust = std::min(trust, trust_in_its_kind);
    if (whole && (stands_in || trust <= 0.5)) remainder.block = whole->block;
    return {trust, std::move(remainder)};
}

/// Whether the gap depends on one thing at most; a command that comes late lacks force by what the command
/// and the speed change by.
bool has_one_face(const Remainder& whole) {
    const std::vector<std::string>& all = whole.depends_on;
    return all.size() <= 1 || (all.size() == 2 && all[0] == name_of(Dependence::command_change) &&
                               all[1] == name_of(Dependence::acceleration));
}

/// Of an explanation that leaves nothing: two causes of the carriage together can do what a third one does,
/// and where a gap of the view is small, one of the camera what the plate does. Then one dependence is
/// enough, of another block.
std::optional<Trust> trust_in_another(const Evidence& evidence, const Selection& selection, double tail) {
    const bool is_of_view = std::ranges::any_of(selection.choices, [](const Choice& choice) {
        return choice.candidate->effect->block == "camera.geometry";
    });
    if (selection.choices.size() < 2 && !is_of_view) return {};
    std::optional<Remainder> whole = remainder_of(evidence, selection.steps.front(), tail);
    if (!whole) return {};
    if (is_displacement_by_camera(selection)) {
        whole->text = "tags: what is named predicts them, but only where it is as large as it may be";
        return Trust{trust_in_stand_in, std::move(*whole)};
    }
    if (!has_one_face(*whole)) return {};
    const bool is_of_plate = whole->block == "plate";
    if (!has_stand_in(selection, *whole, is_of_plate ? 1 : 2)) return {};
    whole->text = fmt::format(
        "{}: what is named predicts it, but its errors depend on {}: that is of {}, where nothing is named",
        is_of_plate ? "tags" : "encoder", whole->depends_on.front(), whole->block);
    return Trust{trust_in_stand_in, std::move(*whole)};
}

}  // namespace

Trust trust_of(const Evidence& evidence, const Selection& selection, const TotalGap& gap, double tail) {
    if (std::optional<Remainder> remainder = remainder_of(evidence, selection.steps.back(), tail))
        return trust_beside(evidence, selection, gap, std::move(*remainder), tail);
    if (std::optional<Trust> trust = trust_in_another(evidence, selection, tail)) return *std::move(trust);
    const double trust = trust_in(typical_floors(evidence.windows(), selection.steps.back().mean_squares));
    return {gap.removed() < removed_at_the_floor ? std::min(trust, trust_in_its_kind) : trust, {}};
}

}  // namespace fidservo::gap
