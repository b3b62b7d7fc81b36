// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Drafts a rig file for a new user: from what they know of their stage, and guesses for numbers that need
// measuring, each with the command that measures it.
#include <array>
#include <filesystem>
#include <string>

namespace fidservo {

enum class RigKind { axis, camera, full };

/// The numbers that the user is asked for; the rest of a rig file is guessed from them.
struct RigDraft {
    RigKind kind = RigKind::full;
    std::string name = "my-rig";
    double tick_s = 0.001;

    std::array<double, 2> travel_mm{0.0, 200.0};
    double resolution_mm = 0.05;
    double command_limit_V = 5.0;
    double friction_V = 0.0;  ///< 0: unknown, a fifth of the limit is assumed

    std::array<double, 2> micro_travel_mm{0.0, 4.0};
    double heater_onset_V = 1.3;
    double heater_limit_V = 1.9;
    int adc_bits = 12;
    double adc_range_V = 5.0;

    std::array<int, 2> image_px{1280, 960};
    double focal_px = 5000.0;
    double distance_mm = 20.0;
    double frame_rate_hz = 50.0;

    double tag_side_mm = 1.2;
    double pitch_mm = 2.0;
    int columns = 0;  ///< 0: as many as the travel needs
    int rows = 1;
    int first_id = 0;

    bool has_micro() const { return kind == RigKind::full; }
    bool has_camera() const { return kind != RigKind::axis; }
};

/// The command below which the axis stays at rest. It is rather chosen too large, as with too small a value
/// the axis sticks.
double friction_V_of(const RigDraft& draft);

/// The columns of tags that reach from plate x = 0 to the end of the travel, at most what the family has.
int columns_of(const RigDraft& draft);

/// Throws InputError, naming the options, if a rig file with these numbers would be refused.
void demand_sound(const RigDraft& draft);

/// The commented rig file. @param fod  what it names as its table of first-order descending curves
std::string rig_text(const RigDraft& draft, const std::string& fod);

}  // namespace fidservo
