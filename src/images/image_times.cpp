// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/images/image_times.h"

#include "core/input_error.h"

#include <algorithm>

#include <fmt/format.h>

namespace fidservo {

namespace {

std::string stem_of(const ImageFrame& frame) {
    return frame.file.stem().string();
}

/// A frame whose time is the frame's before it, if times are in order.
const ImageFrame* first_of_same_time(const std::vector<ImageFrame>& frames) {
    const auto same = std::ranges::adjacent_find(frames, {}, &ImageFrame::time_ns);
    return same == frames.end() ? nullptr : &*same;
}

/// Names of which most, not all, are times; the first that is not one.
const ImageFrame* exception_among(const std::vector<ImageFrame>& frames,
                                  const std::vector<std::string>& stems) {
    std::vector<std::string> times;
    const ImageFrame* exception = nullptr;
    for (std::size_t k = 0; k < stems.size(); ++k) {
        if (names_unit({stems[k]}) != NameTimes::none)
            times.push_back(stems[k]);
        else if (exception == nullptr)
            exception = &frames[k];
    }
    return 2 * times.size() > stems.size() && names_unit(times) != NameTimes::none ? exception : nullptr;
}

}  // namespace

std::string take_times_of_names(const std::string& whose, NameTimes unit, std::vector<ImageFrame>& frames) {
    if (unit == NameTimes::none) return {};
    std::vector<std::string> stems;
    std::ranges::transform(frames, std::back_inserter(stems), stem_of);
    const bool asked = unit != NameTimes::automatic;
    if (!asked) unit = names_unit(stems);
    if (unit == NameTimes::none) {
        if (could_be_times(stems))
            return fmt::format(
                "{}: names look like times: none are taken; say which by --name-times ms or us", whose);
        if (const ImageFrame* exception = exception_among(frames, stems); exception != nullptr)
            return fmt::format("{}: names look like times, but {} does not: none are taken", whose,
                               exception->file.filename().string());
        return {};
    }
    std::vector<ImageFrame> timed = frames;
    for (ImageFrame& frame : timed) {
        frame.time_ns = time_in_name(stem_of(frame), unit);
        if (!frame.time_ns)
            throw InputError(fmt::format("{}: --name-times {}: its name is not such a time",
                                         frame.file.string(), word_for(unit)));
    }
    std::ranges::stable_sort(timed, {}, &ImageFrame::time_ns);
    if (const ImageFrame* same = first_of_same_time(timed); same != nullptr) {
        const std::string which =
            fmt::format("{}: there is another image of the time in its name", same->name);
        if (asked) throw InputError(which);
        return which + ": no times are taken";
    }
    frames = std::move(timed);
    return fmt::format("{}: times are those in the names, in {}", whose, word_for(unit));
}

}  // namespace fidservo
