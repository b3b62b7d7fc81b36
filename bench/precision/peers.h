// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Estimators of other projects and of the literature, for a comparison on the same frames.
#include "tests/tag_precision/precision_trials.h"

#include <memory>
#include <string>
#include <vector>

namespace fidservo::bench {

struct Peer {
    std::string name;
    int draws;  ///< frames at each place between pixels: fewer where one takes long
    precision::Estimator locate;
};

/// libapriltag as it comes and tuned for these frames, OpenCV's ArUco with subpixel corners, ECC (affine) and
/// phase correlation against a noiseless picture of the same tag under the same light, and, with a path to
/// its program, ViSP's detector. Detectors get the frame alone; their time is that of searching the whole
/// frame.
std::vector<Peer> peers_for(const precision::PrecisionCase& of, const std::string& visp_program);

/// The detector that the program itself uses, as libapriltag delivers it.
precision::Estimator tuned_apriltag(int tag_id);

}  // namespace fidservo::bench
