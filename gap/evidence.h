// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What recordings of a rig say about a hypothesis: how far its predictions are from what was measured.
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
// Predictions run over windows of 1 s. The state in which a window begins is estimated from the 100 ms before
// it, by the hypothesis itself; what cannot be seen in 100 ms (hysteresis memory, temperature, play,
// bristles, commands on their way) is carried over from the windows before. Nothing is differentiated and no
// reading inside a window is fed back.
//
// The floor of a signal is what remains under the truth: floor^2 = noise^2 + quantum^2 / 12.
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

/// What is predicted and compared; the top of gap/evidence.h says from what.
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

/// As files have it.
std::string_view name_of(Signal signal);
std::string_view unit_of(Signal signal);  ///< count, adc, px, V, V, floor

/// What a rig is claimed to have beyond its file.
using Hypothesis = std::vector<plant::EffectSetting>;

/// u and v of a tag's four corners.
inline constexpr std::size_t corner_values = 8;

/// What is predicted of a tag's appearance (gap/links/image_link.h).
inline constexpr std::size_t image_values = 10;

/// A stretch of one recording over which one signal is predicted from the state at its start.
struct Window {
    std::size_t run = 0;                  ///< which recording
    Signal signal = Signal::encoder;      ///< which
    TimeNs start_ns = 0;                  ///< its first tick
    std::size_t first_row = 0, rows = 0;  ///< of the recording
    std::size_t begin = 0, end = 0;  ///< its values in Errors: one a row; of tags, corner_values a detection;
                                     ///< of images, image_values an appearance
    std::size_t first_detection = 0;  ///< of the recording's, for tags; sorted by time. Of images: appearance
    /// Mean square of its errors under the truth, floors^2: less than 1 where the encoder's reading stands,
    /// and of images.
    double expected_square = 1.0;
};

/// Prediction minus recording in floors, window after window; NaN where a value does not count (a tag that
/// the plate does not have).
///
/// Counts: where the encoder's reading stands, a place that rounds to it is as good as any other, and the
/// error is what lies beyond half a count; a recording at rest thus counts less than a floor.
///
/// A detection's eight corner coordinates are turned so that the first value lies along the stage's motion in
/// the image; the other seven do not move with it (gap/links/tag_link.h). Their floor is the corner noise,
/// floor(Signal::tag). The first value's own floor also holds what is uncertain of the camera's position.
///
/// Images: logarithms of ratios, each over its own floor (gap/links/image_link.h).
///
/// Commands: gap/links/controller_link.h. They are near 0 under the truth.
using Errors = std::vector<float>;

/// What moved the rig while it was predicted, row by row of a recording: what errors may depend on. All from
/// the recording and the rig file's model. NaN where the rig has no micro stage.
struct Course {
    std::vector<float> position_mm, velocity_mm_per_s;  ///< of the carriage, smoothed over the counts
    std::vector<float> temperature_degC;                ///< of the wire, by the rig file's heater
    std::vector<float> contraction_mm;                  ///< by the Hall reading, smoothed
};

/// A signal of a recording that was not judged, or a part of one, and why.
struct Omission {
    std::string recording;  ///< which
    /// What was not judged, and why.
    std::string signal, why;
    double left_out_s = 0.0, recorded_s = 0.0;  ///< 0 where it is not a matter of time
};

/// What is to be predicted: a flag for each of Evidence::windows().
using Wanted = std::vector<std::uint8_t>;

struct TagSighting;

/// Where a hypothesis has the carriage go along each recording (gap/evidence_parts.h).
struct CarriagePaths;

/// Recordings of a rig, and what hypotheses predict of them.
class Evidence {
  public:
    struct Parts;  ///< gap/evidence_parts.h

    /// @param rig  as its file describes it; its stated effects belong to it
    /// @param budget  asked by all that takes long; empty: no end
    /// Throws InputError where a recording cannot be of this rig (columns that it cannot have, another tick),
    /// BudgetEnded.
    Evidence(const Rig& rig, std::vector<Recording> recordings, std::shared_ptr<const Budget> budget = {});
    ~Evidence();
    /// Takes over all that the other has.
    Evidence(Evidence&&) noexcept;

    /// As its file describes it.
    const Rig& rig() const;
    /// Asked by all that takes long; may be empty.
    const std::shared_ptr<const Budget>& budget() const;
    /// In the order in which they were given.
    const std::vector<Recording>& recordings() const;
    /// By run, then by signal, then by time.
    const std::vector<Window>& windows() const;
    /// In the signal's unit; 1 for images, whose errors have none. NaN for signals that no window has.
    double floor(Signal signal) const;
    /// What is not judged, and why.
    const std::vector<Omission>& omissions() const;
    /// Whether it is known where on the rail the carriage is in a recording (gap/links/power_on.h).
    bool knows_places(std::size_t run) const;
    /// What moved the rig in a recording.
    const Course& course(std::size_t run) const;
    /// One of a recording's detections, in the order of Window::first_detection (gap/links/tag_link.h).
    const TagSighting& sighting(std::size_t run, std::size_t detection) const;

    /// Whether the Hall reading depends on what the carriage does, and so on all that moves the carriage.
    bool platform_feels_carriage(const Hypothesis& hypothesis) const;

    /// Predictions of a hypothesis; values of windows that are not wanted are NaN.
    /// Deterministic, const and safe to call from several threads at once.
    /// Empty if the hypothesis is none that a rig can have (the plant refuses it). Throws BudgetEnded.
    /// @param start_offset_count  by which the carriage begins each window beside the place that fits best
    /// @param known  paths that are followed where the hypothesis moves the carriage as theirs does; may be
    ///               null
    Errors errors(const Hypothesis& hypothesis, const Wanted& wanted, double start_offset_count = 0.0,
                  const CarriagePaths* known = nullptr) const;

    /// Where a hypothesis has the carriage go; null where its predictions need no path of their own, or the
    /// plant refuses it. Throws BudgetEnded.
    std::shared_ptr<const CarriagePaths> paths(const Hypothesis& hypothesis, const Wanted& wanted) const;

    /// What all predictions since it was made have cost, whatever the machine: 1 is a carriage that was
    /// followed in closed form for 5 minutes, or along all recordings where they are longer.
    double effort() const;

  private:
    std::unique_ptr<Parts> parts_;
};

/// All windows.
Wanted everything(const Evidence& evidence);

/// The signals whose prediction an effect can change, by its block.
std::vector<Signal> reach_of(const plant::Effect& effect);

}  // namespace fidservo::gap
