// SPDX-License-Identifier: GPL-3.0-or-later
// Where the fiducials of an image are, and how well that is known.
//
//     01_measure_tag IMAGE
#include "core/input_error.h"
#include "vision/images/image_file.h"
#include "vision/tags/tag_detector.h"
#include "vision/tags/tag_refinement.h"

#include <cmath>
#include <cstdio>

namespace {

void measure(const char* file) {
    using namespace fidservo;
    const Result<cv::Mat> image = vision::read_grey(file);
    if (!image) throw InputError(image.error().text);

    vision::TagDetector detector(vision::thorough_options());
    for (const TagDetection& found : detector.detect(*image, 0)) {
        // The corners by the detector are good to 0.2 px; from all edges of the code they are ten times
        // better.
        const Result<vision::RefinedTag> tag = vision::refine_tag(*image, found);
        if (!tag) {
            std::printf("tag %d: not measured: %s\n", found.tag_id, tag.error().text.c_str());
            continue;
        }
        const Eigen::Matrix2d& covariance = tag->centre_covariance_px2;
        const double std_u = std::sqrt(covariance(0, 0)), std_v = std::sqrt(covariance(1, 1));
        std::printf("tag %d: centre u %.4f +- %.4f px, v %.4f +- %.4f px, correlation %.2f\n", found.tag_id,
                    tag->centre_px.x(), std_u, tag->centre_px.y(), std_v, covariance(0, 1) / (std_u * std_v));
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: 01_measure_tag IMAGE\n");
        return 2;
    }
    try {
        measure(argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "01_measure_tag: %s\n", error.what());
        return 2;
    }
}
