// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The comparison of recordings with a hypothesis on their rig: the errors of its predictions.
//
// The signal chain is cut where something was measured. Every stretch between two cuts is fed with what was
// recorded at its entrance and predicts what was recorded at its exit, so that an error of one stretch does
// not look like one of the next:
//
//     macro_command                        -> encoder         carriage
//     micro_command (macro_command)        -> hall            wire, platform, Hall sensor
//     encoder, hall                        -> tag             camera over the plate
//     tag, from frame to frame             -> image           blur, light and noise of tags in the frames
//     macro_setpoint, encoder              -> macro_command   controllers
//     micro_setpoint, hall                 -> micro_command
//
// Predictions run freely over windows of 1 s. The state in which a window begins is estimated from the 100 ms
// before it, under the hypothesis itself; states that 100 ms do not reveal (hysteresis memory, temperature,
// play, bristle deflection, delayed commands) are carried over from the windows before. No measurement is
// differentiated, and no reading inside a window is fed back.
//
// The floor of a signal is the r.m.s. error that remains under the truth, by noise and rounding: floor^2 =
// noise^2 + quantum^2 / 12.
#include "core/recording.h"
#include "gap/budget.h"
#include "plant/effects/effect.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo {
struct Rig;
}

namespace fidservo::gap {

/// The signals that are predicted and compared; the inputs of each prediction are listed at the top of this
/// file.
enum class Signal : std::uint8_t {
    encoder,        ///< the carriage's reading
    hall,           ///< the platform's reading
    tag,            ///< the corners of a tag
    macro_command,  ///< the macro controller's command
    micro_command,  ///< the micro controller's command
    image,          ///< blur, light and noise of tags
};
/// How many signals there are.
inline constexpr std::size_t signal_count = 6;

/// A signal's place in arrays of signal_count.
constexpr std::size_t index_of(Signal signal) {
    return static_cast<std::size_t>(signal);
}

/// The name that files use.
std::string_view name_of(Signal signal);
std::string_view unit_of(Signal signal);  ///< in the order of Signal: count, adc, px, V, V, floor

/// The effects that a rig is claimed to have beyond its file, with their parameters.
using Hypothesis = std::vector<plant::EffectSetting>;

/// Corners of a tag.
inline constexpr int corner_count = 4;
/// Each corner's share of a tag's middle.
inline constexpr double corner_share = 1.0 / corner_count;
/// Number of values of a detection: u and v of the tag's corners.
inline constexpr std::size_t corner_values = 2 * corner_count;

/// Number of values that describe a tag's appearance in a frame (gap/links/image_link.h).
inline constexpr std::size_t image_values = 2 * corner_count + 2;

/// A stretch of one recording over which one signal is predicted from the state at its start.
struct Window {
    std::size_t run = 0;                  ///< index of the recording
    Signal signal = Signal::encoder;      ///< the signal that is predicted
    TimeNs start_ns = 0;                  ///< time of its first tick
    std::size_t first_row = 0, rows = 0;  ///< rows of the recording
    /// Range of its values in Errors: one value for each row; for tags, corner_values for each detection; for
    /// images, image_values for each appearance.
    std::size_t begin = 0, end = 0;
    /// For tags, index of its first detection among those of the recording, sorted by time; for images, of
    /// its first appearance.
    std::size_t first_detection = 0;
    /// Mean square of its errors under the truth, floors^2: 1, but less for images and where the encoder's
    /// reading is constant.
    double expected_square = 1.0;
};

/// Prediction minus recording, in floors, window after window; NaN where a value does not count (such as that
/// of a tag that the plate does not have).
///
/// Encoder: while the reading is constant, all positions that round to it are equally good, so that only the
/// part of the error beyond half a count counts. A recording at rest thus has errors below its floor.
///
/// Tags: the eight corner coordinates of a detection are transformed such that the first value lies along the
/// stage's motion in the image and the other seven do not change with that motion (gap/links/tag_link.h). The
/// floor of these is the corner noise, floor(Signal::tag); that of the first value also contains the
/// uncertainty of the camera's position.
///
/// Images: logarithms of predicted over measured values, each in its own floors (gap/links/image_link.h).
///
/// Commands: see gap/links/controller_link.h. Under the truth their errors are near 0.
using Errors = std::vector<float>;

/// Motion and temperature along a recording, on which errors may depend: one value for each row, from the
/// recording and the rig file's model. The wire's values are NaN where the rig has no micro stage.
struct Course {
    std::vector<float> position_mm, velocity_mm_per_s;  ///< of the carriage, without the steps of the counts
    std::vector<float> temperature_degC;                ///< of the wire, by the rig file's heater model
    std::vector<float> contraction_mm;                  ///< of the wire, by the smoothed Hall reading
};

/// A signal of a recording, or a part of it, that was not judged.
struct Omission {
    std::string recording;  ///< its name
    /// What was not judged, and the reason.
    std::string signal, why;
    double left_out_s = 0.0, recorded_s = 0.0;  ///< 0 if the omission has no duration
};

/// Which windows to predict: a flag for each of Evidence::windows().
using Wanted = std::vector<std::uint8_t>;

struct TagSighting;

/// The carriage's motion along each recording under a hypothesis (gap/evidence_parts.h).
struct CarriagePaths;

/// Recordings of a rig, and what hypotheses predict of them.
class Evidence {
  public:
    struct Parts;  ///< gap/evidence_parts.h

    /// @param rig  as its file describes it, with the effects that the file states
    /// @param budget  the time budget, which all lengthy computations check; null: unlimited
    /// Throws InputError where a recording cannot be of this rig (columns that it cannot have, another tick),
    /// and BudgetEnded.
    Evidence(const Rig& rig, std::vector<Recording> recordings, std::shared_ptr<const Budget> budget = {});
    ~Evidence();
    /// Leaves the other one without content.
    Evidence(Evidence&&) noexcept;

    /// The rig as its file describes it.
    const Rig& rig() const;
    /// The time budget, which all lengthy computations check.
    const std::shared_ptr<const Budget>& budget() const;
    /// The recordings in the given order; those that continue another one are joined to it
    /// (gap/links/power_on.h).
    const std::vector<Recording>& recordings() const;
    /// Sorted by run, then by signal, then by time.
    const std::vector<Window>& windows() const;
    /// The floor in the signal's unit; 1 for images, whose errors are relative to their own floors; NaN for
    /// signals without windows.
    double floor(Signal signal) const;
    /// What is not judged, and why.
    const std::vector<Omission>& omissions() const;
    /// Whether the carriage's position on the rail is known in a recording (gap/links/power_on.h).
    bool knows_places(std::size_t run) const;
    /// Motion and temperature along a recording.
    const Course& course(std::size_t run) const;
    /// One of a recording's detections, in the order of Window::first_detection (gap/links/tag_link.h).
    const TagSighting& sighting(std::size_t run, std::size_t detection) const;

    /// Whether, under a hypothesis, the carriage's motion affects the Hall reading.
    bool platform_feels_carriage(const Hypothesis& hypothesis) const;

    /// Errors of a hypothesis's predictions; NaN in windows that are not wanted. Empty if the plant refuses
    /// the hypothesis. Deterministic, const and safe to call from several threads at once. Throws
    /// BudgetEnded.
    /// @param start_offset_count  added to the carriage's best-fitting position at the start of each window
    /// @param known  paths that are used if the hypothesis moves the carriage as theirs does; may be null
    Errors errors(const Hypothesis& hypothesis, const Wanted& wanted, double start_offset_count = 0.0,
                  const CarriagePaths* known = nullptr) const;

    /// The carriage's motion under a hypothesis; null where the hypothesis does not change it, no wanted
    /// prediction needs it, or the plant refuses the hypothesis. Throws BudgetEnded.
    /// @param known  returned again where the hypothesis moves the carriage as its paths do; may be null
    std::shared_ptr<const CarriagePaths> paths(const Hypothesis& hypothesis, const Wanted& wanted,
                                               std::shared_ptr<const CarriagePaths> known = {}) const;

    /// The cost of all predictions so far, independent of the machine. Its unit is the cost of simulating a
    /// carriage by its closed-form solution for 5 minutes, or along all recordings if they are longer.
    double effort() const;

  private:
    std::unique_ptr<Parts> parts_;
};

/// All windows.
Wanted everything(const Evidence& evidence);

/// The signals whose prediction an effect can change, by the block of the signal chain on which it acts.
std::vector<Signal> reach_of(const plant::Effect& effect);

}  // namespace fidservo::gap
