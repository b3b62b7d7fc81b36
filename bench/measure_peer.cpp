// SPDX-License-Identifier: GPL-3.0-or-later
// measure_peer RIG.yaml IMAGE: what bench/python_bench.py compares the Python module with. For every line
// that it reads it measures the image once, and prints how long that took, s, and how many tags there are.
#include "core/rig.h"
#include "src/files/rig/rig_file.h"
#include "src/replay/tag_finder.h"
#include "src/replay/tag_options.h"
#include "vision/images/image_file.h"

#include <chrono>
#include <cstdio>
#include <iostream>
#include <string>

#include <fmt/format.h>

int main(int argc, char** argv) {
    using namespace fidservo;
    if (argc != 3) return 2;
    const Rig rig = load_rig(argv[1]);
    const auto image = vision::read_grey(argv[2]);
    if (!rig.camera || !rig.fiducials || !image) return 2;
    TagFinder finder(rig.camera, reading_of({}, rig.fiducials->print));
    for (std::string line; std::getline(std::cin, line);) {
        const bool is_of_machine = line == "machine";
        const auto start = std::chrono::steady_clock::now();
        const std::size_t tags = finder.measure(*image, 0, is_of_machine).refined.size();
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        fmt::print("{} {}\n", took.count(), tags);
        std::fflush(stdout);
    }
    return 0;
}
