// SPDX-License-Identifier: GPL-3.0-or-later
// ViSP's tag detector on raw frames from standard input: visp_peer WIDTH HEIGHT TAG_ID. Answers each frame
// with one line: "none", or the tag's corners u0 v0 .. u3 v3 in px, pixel centres at integers.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <vector>

#include <visp3/core/vpImage.h>
#include <visp3/detection/vpDetectorAprilTag.h>

/// ViSP hands on libapriltag's coordinates, in which pixel centres lie at +0.5.
constexpr double centre_px = 0.5;

namespace {

void answer_frames(char** argv) {
    const auto width = static_cast<unsigned>(std::atoi(argv[1]));
    const auto height = static_cast<unsigned>(std::atoi(argv[2]));
    const int tag_id = std::atoi(argv[3]);
    vpDetectorAprilTag detector(vpDetectorAprilTag::TAG_36h11);
    vpImage<unsigned char> frame(height, width);
    const std::size_t count = static_cast<std::size_t>(width) * height;
    while (std::fread(frame.bitmap, 1, count, stdin) == count) {
        const std::clock_t begin = std::clock();
        detector.detect(frame);
        std::printf("%.6g", 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
        const std::vector<int> ids = detector.getTagsId();
        std::size_t found = 0;
        while (found < ids.size() && ids[found] != tag_id) ++found;
        if (found < ids.size())
            for (const vpImagePoint& corner : detector.getPolygon(found))
                std::printf(" %.9g %.9g", corner.get_u() - centre_px, corner.get_v() - centre_px);
        std::puts("");
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) return 2;
    try {
        answer_frames(argv);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "visp_peer: %s\n", error.what());
        return 1;
    }
}
