// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Names for the parts of a diagnosis in sentences.
#include "gap/diagnosis.h"

#include <string>
#include <string_view>

namespace fidservo {
struct HallParameters;
struct Rig;
}  // namespace fidservo

namespace fidservo::diagnose {

/// A block in a sentence: "the motor's drive" for macro.drive. The block itself where it has no other name.
std::string block_words(std::string_view block);

/// A signal in a sentence: "encoder reading".
std::string_view signal_words(gap::Signal signal);

/// What a remainder depends on, in a sentence: "position with a period of 2.5 mm" for "position, periodic
/// (2.5 mm)".
std::string dependence_words(const std::string& dependence);

/// A name without its underscores.
std::string readable(std::string_view name);

/// "a", "a and b", "a, b and c".
std::string enumerated(const std::vector<std::string>& parts);

/// With a capital first letter.
std::string capitalised(std::string text);

/// Three significant digits, a true minus sign: "0.0312", "1.05", "30.3", "12 400", "2.08 x 10^6" (typeset).
std::string three_digits(double value);

/// A gap in floors: three digits, or "< 0.1".
std::string floors_words(double floors);

/// A probability in percent, never quite 0 or 1: "93.1 %", "> 99.9 %".
std::string probability_words(double probability);

/// A share in percent: "45.6 %", "> 99.9 %", "100 %".
std::string share_words(double share);

/// The unit in which a signal is displayed; one of its own units is `per_own_unit` of it.
struct DisplayUnit {
    std::string_view unit;
    double per_own_unit;
};

/// Encoder counts are displayed in um, or in mm if the values are large; commands in mV; Hall readings and
/// corners in their own units.
/// @param largest  the largest value to be displayed, in the signal's own unit
DisplayUnit display_unit(const Rig& rig, gap::Signal signal, double largest);

/// A size in its display unit: "12.5 um".
std::string shown_size(const Rig& rig, gap::Signal signal, double own_unit);

/// The platform's motion, um, per LSB of the Hall reading in the middle of its range.
double hall_um_per_lsb(const HallParameters& hall);

/// The motion of the platform that a size of the Hall reading stands for in the middle of the range, "25 um".
/// Demands a micro stage.
std::string platform_motion(const Rig& rig, double hall_lsb);

/// The effects that the recordings cannot distinguish from one, without those that are in the explanation
/// themselves.
std::vector<std::string> ties_of(const gap::FoundEffect& effect, const gap::Diagnosis& diagnosis);

/// The size class of a gap in floors, 0 (at the floor) .. 4, as in the style sheet's "size-0".
int size_class(double floors);

}  // namespace fidservo::diagnose
