// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras of either lens model, drawn at random, before a hand-held target: the lens is found within its
// stated standard errors, or refused for the reason that was built into the draw.
#include "calib/camera/calibration_verdict.h"
#include "calib/camera/other_explanations.h"
#include "tests/calib_camera/hand_held.h"
#include "tests/effort.h"
#include "tests/variations.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include <fmt/format.h>

namespace fidservo::calib {
namespace {

const int tried = testing::draws(200, 20);
/// For kinds in which every answer takes a dozen calibrations.
const int tried_of_long = testing::draws(25, 5);
constexpr double side_mm = 88.0, pitch_mm = 114.4;

std::vector<PlateTag> small_target() {
    return tag_grid(4, 3, side_mm, pitch_mm);
}

/// Half the image's width over the focal length.
double reach_of(const CameraGeometry& lens) {
    return 0.5 * lens.width_px / lens.focal_px;
}

/// A random camera. Half its angle of view is 40 to 97 degrees for an equidistant lens, and 10 to 40 degrees
/// for a plumb_bob one.
CameraGeometry some_camera(LensModel model, NoiseStream& random) {
    const double width_px = std::round(between(random, 400.0, 1600.0));
    const double height_px = std::round(width_px * between(random, 0.6, 1.0));
    CameraGeometry lens{static_cast<int>(width_px), static_cast<int>(height_px), 1.0, {0.0, 0.0}, 1.0};
    lens.principal_point_px = {width_px * between(random, 0.48, 0.52),
                               height_px * between(random, 0.48, 0.52)};
    if (model == LensModel::equidistant) {
        lens.focal_px = 0.5 * width_px / between(random, 0.7, 1.7);
        lens.distortion = {.k1 = between(random, -0.05, 0.08),
                           .k2 = between(random, -0.01, 0.01),
                           .k3 = between(random, -0.003, 0.003),
                           .k4 = between(random, -0.0005, 0.0005),
                           .model = model};
        return lens;
    }
    lens.focal_px = width_px * between(random, 0.6, 3.0);
    const double reach2 = std::pow(reach_of(lens), 2);
    lens.distortion = {.k1 = between(random, -0.2, 0.1) / reach2,
                       .k2 = random.uniform() < 0.5 ? 0.0 : between(random, -0.05, 0.05) / (reach2 * reach2),
                       .p1 = between(random, -1e-3, 1e-3),
                       .p2 = between(random, -1e-3, 1e-3)};
    return lens;
}

Handling some_handling(const CameraGeometry& lens, NoiseStream& random) {
    const double reach = reach_of(lens);
    return {.views = static_cast<int>(between(random, 7.0, 10.0)),
            .most_off_axis_rad =
                lens.distortion.model == LensModel::equidistant ? 0.8 * reach : 0.6 * std::atan(reach),
            .noise_px = between(random, 0.03, 0.15)};
}

/// A number of the lens that is farther from the truth than four of its standard errors.
std::optional<std::string> too_far(const CameraCalibration& found, const CameraGeometry& truth) {
    const Lens is = lens_of(found.camera), was = lens_of(truth);
    for (std::size_t k = 0; k < lens_parameters; ++k) {
        const auto parameter = static_cast<LensParameter>(k);
        if (!found.fitted[k] || std::abs(is[k] - was[k]) <= 4.0 * found.std_of(parameter)) continue;
        return fmt::format("{} {} +- {}, truly {}", name_of(parameter), is[k], found.std_of(parameter),
                           was[k]);
    }
    return std::nullopt;
}

struct Answer {
    std::optional<CameraCalibration> found;
    std::vector<std::string> reasons,
        notes;  ///< reasons of a refusal; notes of what is accepted
    bool accepted() const { return reasons.empty(); }
    bool says(std::string_view part) const {
        const auto has = [&](const std::string& line) { return line.find(part) != std::string::npos; };
        return std::ranges::any_of(reasons, has) || std::ranges::any_of(notes, has);
    }
    std::string text() const {
        return reasons.empty() ? fmt::format("{}", fmt::join(notes, " | "))
                               : fmt::format("{}", fmt::join(reasons, " | "));
    }
};

std::optional<double> number_after(const Answer& answer, const std::string& words) {
    for (const std::string& line : answer.reasons)
        if (const auto at = line.find(words); at != std::string::npos)
            return std::stod(line.substr(at + words.size()));
    return std::nullopt;
}

/// The command's judgement, without the requirement on how much of the image the target covered.
Answer answer_of(const std::vector<TargetView>& views, const CameraGeometry& camera, LensModel model,
                 const std::vector<PlateTag>& target) {
    const CalibrationLimits limits{.least_coverage = 0.0};
    auto found = calibrate_camera(views, options_for_lens(camera, model));
    if (!found) return {std::nullopt, {found.error().text}, {}};
    count_other_model(*found);
    Answer answer{*found, shortcomings(*found, limits, target), {}};
    if (answer.accepted()) answer.notes = notes_on(*found);
    return answer;
}

template <class Trial>
void try_all(const std::string& kind, Trial trial, int number = tried, int known_wrong = 0) {
    expect_right_or_refused(
        kind, number,
        [&](std::mt19937_64& draw) {
            NoiseStream random(draw(), "calibration " + kind);
            return trial(random);
        },
        known_wrong);
}

Outcome right_or_refused(const Answer& answer, const CameraGeometry& truth) {
    if (!answer.accepted()) return Outcome::refused(answer.reasons.front());
    if (const auto far = too_far(*answer.found, truth))
        return answer.notes.empty() ? Outcome::wrong(*far) : Outcome::refused(answer.notes.front());
    return Outcome::right();
}

void try_right_model(const std::string& kind, LensModel model) {
    try_all(kind, [&](NoiseStream& random) {
        const CameraGeometry camera = some_camera(model, random);
        const auto views = hand_held_views(camera, small_target(), some_handling(camera, random), random);
        const Answer answer = answer_of(views, camera, model, small_target());
        // Model, target and views are as stated: only the views may be too few.
        for (const char* untrue : {"does not describe", "spacing", "rows of", "lens fits", "without view"})
            if (!answer.accepted() && answer.says(untrue)) return Outcome::wrong(answer.reasons.front());
        return right_or_refused(answer, camera);
    });
}

TEST(SlowCalibrationVariations, PlumbBobLenses_AreRightOrRefused) {
    try_right_model("plumb_bob lens", LensModel::plumb_bob);
}

TEST(SlowCalibrationVariations, EquidistantLenses_AreRightOrRefused) {
    try_right_model("equidistant lens", LensModel::equidistant);
}

/// Where the lens model that was asked for does not fit, the answer names the one that does; where it fits,
/// the numbers are right or stated to be uncertain.
void try_wrong_model(const std::string& kind, LensModel truth, LensModel asked, int number,
                     int known_wrong = 0) {
    try_all(
        kind,
        [&](NoiseStream& random) {
            const CameraGeometry camera = some_camera(truth, random);
            const auto views = hand_held_views(camera, small_target(), some_handling(camera, random), random);
            const Answer answer = answer_of(views, camera, asked, small_target());
            if (answer.says(fmt::format("--lens {}", name_of(truth))))
                return Outcome::refused(answer.reasons.empty() ? answer.notes.front()
                                                               : answer.reasons.front());
            for (const char* untrue : {"spacing", "rows of", "without view"})
                if (!answer.accepted() && answer.says(untrue)) return Outcome::wrong(answer.reasons.front());
            Answer compared = answer;
            if (compared.found)  // for the parameters that both models have
                for (std::size_t k = k1; k <= k4; ++k) compared.found->fitted[k] = false;
            return right_or_refused(compared, camera);
        },
        number, known_wrong);
}

TEST(SlowCalibrationVariations, EquidistantLensTakenForPlumbBob_IsNamed) {
    try_wrong_model("equidistant lens as plumb_bob", LensModel::equidistant, LensModel::plumb_bob,
                    tried_of_long);
}

/// Of 200 draws, one has a principal point that is 4.4 standard errors off, for which the other model does
/// not account.
TEST(SlowCalibrationVariations, PlumbBobLensTakenForEquidistant_IsNamed) {
    constexpr int known_wrong = 1;
    try_wrong_model("plumb_bob lens as equidistant", LensModel::plumb_bob, LensModel::equidistant, tried,
                    known_wrong);
}

LensModel some_model(NoiseStream& random) {
    return random.uniform() < 0.5 ? LensModel::plumb_bob : LensModel::equidistant;
}

TEST(SlowCalibrationVariations, WrongSpacing_IsNamedWithTheRightOne) {
    try_all(
        "wrong spacing",
        [&](NoiseStream& random) {
            const LensModel model = some_model(random);
            const CameraGeometry camera = some_camera(model, random);
            const auto said = small_target();
            auto truth = said;
            // One in eight is as stated.
            const double true_side_mm =
                side_mm * (random.uniform() < 0.125 ? 1.0 : std::exp(between(random, -0.5, 0.2)));
            for (PlateTag& tag : truth) tag.side_mm = true_side_mm;
            auto views = hand_held_views(camera, truth, some_handling(camera, random), random);
            for (TargetView& view : views)
                for (TagSight& sight : view.tags) sight.printed.side_mm = side_mm;
            const Answer answer = answer_of(views, camera, model, said);
            const auto named = number_after(answer, "the gap between the tags is ");
            if (named && std::abs((1.0 + *named) * true_side_mm / pitch_mm - 1.0) < 0.005)
                return Outcome::refused(answer.reasons.front());
            if (answer.accepted() && answer.says("is the target printed as said?"))
                return Outcome::refused(answer.notes.back());
            // A refusal because of the focal length's error counts as right, whatever the size.
            if (answer.says("the focal length is not determined"))
                return Outcome::refused(answer.reasons.front());
            if (!answer.accepted())
                return Outcome::wrong(
                    fmt::format("scale {:.3f}: {}", true_side_mm / side_mm, answer.reasons.front()));
            return right_or_refused(answer, camera);
        },
        tried_of_long);
}

TEST(SlowCalibrationVariations, WrongGrid_IsNamedWithTheRightOne) {
    try_all(
        "wrong grid",
        [&](NoiseStream& random) {
            const LensModel model = some_model(random);
            const CameraGeometry camera = some_camera(model, random);
            const int columns = static_cast<int>(between(random, 3.0, 7.0));
            int said_columns = static_cast<int>(between(random, 2.0, 7.0));
            if (said_columns == columns) ++said_columns;
            if (random.uniform() < 0.125) said_columns = columns;  // one in eight is as stated
            const auto truth = tag_grid(columns, 4, side_mm, pitch_mm);
            auto said =
                tag_grid(said_columns, (4 * columns + said_columns - 1) / said_columns, side_mm, pitch_mm);
            auto views = hand_held_views(camera, truth, some_handling(camera, random), random);
            for (TargetView& view : views)
                for (TagSight& sight : view.tags)
                    sight.printed = said[static_cast<std::size_t>(sight.printed.id)];
            const Answer answer = answer_of(views, camera, model, said);
            if (said_columns == columns) return right_or_refused(answer, camera);
            const std::string right =
                fmt::format("the tags stand in rows of {}, not of {}", columns, said_columns);
            if (answer.says(right) || answer.says("as it is described, do"))
                return Outcome::refused(answer.reasons.front());
            return Outcome::wrong(answer.text());
        },
        tried_of_long);
}

TEST(SlowCalibrationVariations, TooLittleTilt_IsNamedOnlyWhereMoreWouldDo) {
    try_all("too little tilt", [&](NoiseStream& random) {
        const CameraGeometry camera = some_camera(LensModel::plumb_bob, random);
        Handling handling = some_handling(camera, random);
        handling.least_tilt_rad = 0.0;
        handling.most_tilt_rad = between(random, 0.0, 0.3);
        handling.most_off_axis_rad *= 0.3;
        const auto views = hand_held_views(camera, small_target(), handling, random);
        const Answer answer = answer_of(views, camera, LensModel::plumb_bob, small_target());
        if (!answer.says("tilt it more")) return right_or_refused(answer, camera);
        // The advice is followed: the same number of views, tilted by 30 degrees more to all sides.
        handling.least_tilt_rad += 0.5;
        handling.most_tilt_rad += 0.5;
        const auto better = answer_of(hand_held_views(camera, small_target(), handling, random), camera,
                                      LensModel::plumb_bob, small_target());
        if (better.found && better.found->std_of(focal) <= 0.5 * answer.found->std_of(focal))
            return Outcome::refused(answer.reasons.front());
        return Outcome::wrong(answer.reasons.front() + ": it did not help");
    });
}

TEST(SlowCalibrationVariations, FewViews_AreRefused) {
    try_all("few views", [&](NoiseStream& random) {
        const LensModel model = some_model(random);
        const CameraGeometry camera = some_camera(model, random);
        Handling handling = some_handling(camera, random);
        handling.views = static_cast<int>(between(random, 1.0, 8.0));
        const auto views = hand_held_views(camera, small_target(), handling, random);
        const Answer answer = answer_of(views, camera, model, small_target());
        if (handling.views < 5 && answer.accepted()) return Outcome::wrong("accepted");
        for (const char* untrue : {"does not describe", "spacing", "rows of", "lens fits"})
            if (!answer.accepted() && answer.says(untrue)) return Outcome::wrong(answer.reasons.front());
        return right_or_refused(answer, camera);
    });
}

}  // namespace
}  // namespace fidservo::calib
