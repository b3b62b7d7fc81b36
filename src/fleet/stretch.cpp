// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/stretch.h"

#include "src/fleet/task_name.h"

#include <algorithm>

#include <fmt/format.h>

namespace fidservo::fleet {
namespace {

void cut(const ImageFrames::Series& series, std::size_t number, std::vector<Stretch>& stretches) {
    const std::size_t most = series.is_video ? pictures_a_stretch : images_a_stretch;
    const std::string noted = noted_path(series.name);
    std::size_t first = 0;
    do {
        const std::size_t count = std::min(most, series.frames - first);
        stretches.push_back({number, first, count, series.is_video && first + count == series.frames, noted});
        first += count;
    } while (first < series.frames);
}

}  // namespace

std::string Stretch::stem() const {
    return fmt::format("{}+{:07}", file_stem(noted), first);
}

std::vector<Stretch> stretches_of(const std::vector<ImageFrames::Series>& series) {
    std::vector<Stretch> stretches;
    bool may_grow = false;  // the last one is of single images
    for (std::size_t k = 0; k < series.size(); ++k) {
        const bool is_single = !series[k].is_video && series[k].frames == 1;
        if (is_single && may_grow && stretches.back().count < images_a_stretch)
            ++stretches.back().count;
        else
            cut(series[k], k, stretches);
        may_grow = is_single;
    }
    return stretches;
}

}  // namespace fidservo::fleet
