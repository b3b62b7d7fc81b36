// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A signal along a recording for its plots over time: recorded values and both errors, at the times of rows
// or frames.
#include "src/diagnose/report/predictions.h"
#include "src/diagnose/words.h"

#include <string_view>
#include <vector>

namespace fidservo::diagnose {

/// One value for each time. NaN where nothing was recorded or predicted.
struct TraceCourse {
    std::vector<double> time_s;   ///< since the recording's first row
    std::vector<float> recorded;  ///< in the unit of values; empty for tags and images
    std::vector<float> nominal_error,
        explained_error;  ///< in the unit of errors; of tags along the motion, of images the edges', floors
    std::vector<float> nominal_across,
        explained_across;  ///< for tags: r.m.s. across the motion; for images: errors of light and noise
};

/// The unit in which values are plotted: mm where errors are in um.
struct ValueUnit {
    std::string_view unit;
    float per_error_unit;
    int digits;
};

/// @param errors  the unit in which errors are plotted
ValueUnit value_unit(gap::Signal signal, const DisplayUnit& errors);

/// For any signal but tags and images, a value for each row.
/// @param display  the unit in which errors are plotted
TraceCourse course_of_rows(const gap::Evidence& evidence, const Predictions& predictions, std::size_t run,
                           gap::Signal signal, const DisplayUnit& display);

/// For tags, a value for each frame: the mean over its tags.
TraceCourse course_of_frames(const gap::Evidence& evidence, const Predictions& predictions, std::size_t run);

/// For images, a value for each appearance.
TraceCourse course_of_looks(const gap::Evidence& evidence, const Predictions& predictions, std::size_t run);

}  // namespace fidservo::diagnose
