// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A signal along a recording as its traces need it: recorded values and both errors, at the times of rows or
// frames.
#include "src/diagnose/report/predictions.h"
#include "src/diagnose/words.h"

#include <string_view>
#include <vector>

namespace fidservo::diagnose {

/// One value a time. NaN where nothing was recorded or predicted.
struct TraceCourse {
    std::vector<double> time_s;   ///< since the recording's first row
    std::vector<float> recorded;  ///< in the unit of values; empty for tags and images
    std::vector<float> nominal_error,
        explained_error;  ///< in the unit of errors; of tags along the motion, of images the edges', floors
    std::vector<float> nominal_across,
        explained_across;  ///< of tags: r.m.s. across it; of images: of light and noise
};

/// In which unit values are drawn: errors of um are those of mm.
struct ValueUnit {
    std::string_view unit;
    float per_error_unit;
    int digits;
};

/// @param errors  in which unit the errors are drawn
ValueUnit value_unit(gap::Signal signal, const DisplayUnit& errors);

/// Of any signal but tags and images, a value a row.
/// @param display  in which unit the errors are drawn
TraceCourse course_of_rows(const gap::Evidence& evidence, const Predictions& predictions, std::size_t run,
                           gap::Signal signal, const DisplayUnit& display);

/// Of tags, a value a frame: the mean of its tags.
TraceCourse course_of_frames(const gap::Evidence& evidence, const Predictions& predictions, std::size_t run);

/// Of images, a value an appearance.
TraceCourse course_of_looks(const gap::Evidence& evidence, const Predictions& predictions, std::size_t run);

}  // namespace fidservo::diagnose
