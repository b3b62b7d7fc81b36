// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/precision/peers.h"

#include "bench/precision/child_detector.h"

#include <cmath>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
}
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace fidservo::bench {
namespace {

using precision::Estimate;
using precision::Estimator;
using precision::Trial;

/// Where the diagonals of a quadrangle cross: the image of a square's centre, tilted or not.
Eigen::Vector2d crossing(const std::vector<cv::Point2f>& corners) {
    const Eigen::Vector2d a(corners[0].x, corners[0].y), b(corners[1].x, corners[1].y),
        c(corners[2].x, corners[2].y), d(corners[3].x, corners[3].y);
    const Eigen::Vector2d p = c - a, q = d - b, r = b - a;
    return a + p * (r.x() * q.y() - r.y() * q.x()) / (p.x() * q.y() - p.y() * q.x());
}

class AprilTag {
  public:
    AprilTag(int tag_id, bool tuned)
        : tag_id_(tag_id), family_(tag36h11_create()), detector_(apriltag_detector_create()) {
        apriltag_detector_add_family(detector_, family_);
        if (!tuned) return;
        detector_->quad_decimate = 1.0F;
        detector_->qtp.min_white_black_diff = 30;
    }
    AprilTag(const AprilTag&) = delete;
    AprilTag& operator=(const AprilTag&) = delete;
    ~AprilTag() {
        apriltag_detector_destroy(detector_);
        tag36h11_destroy(family_);
    }

    std::optional<Estimate> locate(const cv::Mat1b& frame) {
        cv::Mat1b copy = frame.clone();
        image_u8_t image{copy.cols, copy.rows, static_cast<int>(copy.step), copy.data};
        zarray_t* found = apriltag_detector_detect(detector_, &image);
        std::optional<Estimate> estimate;
        for (int k = 0; k < zarray_size(found); ++k) {
            apriltag_detection_t* tag = nullptr;
            zarray_get(found, k, &tag);
            if (tag->id == tag_id_) estimate = Estimate{{tag->c[0] - 0.5, tag->c[1] - 0.5}, std::nullopt};
        }
        apriltag_detections_destroy(found);
        return estimate;
    }

  private:
    int tag_id_;
    apriltag_family_t* family_;
    apriltag_detector_t* detector_;
};

Estimator apriltag(int tag_id, bool tuned) {
    return [detector = std::make_shared<AprilTag>(tag_id, tuned)](const Trial& trial) {
        return detector->locate(trial.frame);
    };
}

Estimator aruco(int tag_id) {
    const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11);
    const auto parameters = cv::aruco::DetectorParameters::create();
    parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
    return [=](const Trial& trial) -> std::optional<Estimate> {
        std::vector<std::vector<cv::Point2f>> corners;
        std::vector<int> ids;
        cv::aruco::detectMarkers(trial.frame, dictionary, corners, ids, parameters);
        for (std::size_t k = 0; k < ids.size(); ++k)
            if (ids[k] == tag_id) return Estimate{crossing(corners[k]), std::nullopt};
        return std::nullopt;
    };
}

/// What a matching method knows: the tag in the middle of its range, without noise, cover and glare.
cv::Mat1f reference_picture(const precision::PrecisionCase& of) {
    precision::TagScene scene = of.scene;
    scene.cover.reset();
    scene.glare.reset();
    const cv::Mat1d mean = precision::mean_picture(scene);
    cv::Mat1f picture(mean.size());
    for (int v = 0; v < mean.rows; ++v)
        for (int u = 0; u < mean.cols; ++u)
            picture(v, u) = static_cast<float>(precision::grey_of(of.sensor, mean(v, u)));
    return picture;
}

cv::Rect around(const precision::PrecisionCase& of, double margin_px) {
    const double half = 0.5 * of.scene.side_px + margin_px;
    const Eigen::Vector2d low = of.scene.centre_px - Eigen::Vector2d(half, half);
    return cv::Rect(static_cast<int>(low.x()), static_cast<int>(low.y()), static_cast<int>(2 * half),
                    static_cast<int>(2 * half)) &
           cv::Rect({}, of.scene.size_px());
}

Estimator ecc(const precision::PrecisionCase& of) {
    const cv::Rect window = around(of, 15.0);
    const cv::Mat1f reference = reference_picture(of)(window).clone();
    const Eigen::Vector2d centre = of.scene.centre_px;
    return [=](const Trial& trial) -> std::optional<Estimate> {
        cv::Mat1f warp = (cv::Mat1f(2, 3) << 1, 0, window.x, 0, 1, window.y);
        const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 30, 1e-6);
        try {
            cv::Mat1f seen;
            trial.frame.convertTo(seen, CV_32F);
            cv::findTransformECC(reference, seen, warp, cv::MOTION_AFFINE, until, cv::noArray(), 5);
        } catch (const cv::Exception&) {
            return std::nullopt;  // it did not converge
        }
        const double x = centre.x() - window.x, y = centre.y() - window.y;
        return Estimate{
            {warp(0, 0) * x + warp(0, 1) * y + warp(0, 2), warp(1, 0) * x + warp(1, 1) * y + warp(1, 2)},
            std::nullopt};
    };
}

Estimator phase_correlation(const precision::PrecisionCase& of) {
    const cv::Rect window = around(of, 40.0);
    const cv::Mat1f reference = reference_picture(of)(window).clone();
    cv::Mat1f hanning;
    cv::createHanningWindow(hanning, window.size(), CV_32F);
    const Eigen::Vector2d centre = of.scene.centre_px;
    return [=](const Trial& trial) -> std::optional<Estimate> {
        cv::Mat1f seen;
        trial.frame(window).convertTo(seen, CV_32F);
        const cv::Point2d shift = cv::phaseCorrelate(reference, seen, hanning);
        return Estimate{centre + Eigen::Vector2d(shift.x, shift.y), std::nullopt};
    };
}

}  // namespace

Estimator tuned_apriltag(int tag_id) {
    return apriltag(tag_id, true);
}

std::vector<Peer> peers_for(const precision::PrecisionCase& of, const std::string& visp_program) {
    std::vector<Peer> peers{{"libapriltag, defaults", 2, apriltag(of.scene.tag_id, false)},
                            {"libapriltag, tuned", 5, tuned_apriltag(of.scene.tag_id)},
                            {"ArUco, subpixel corners", 2, aruco(of.scene.tag_id)},
                            {"ECC, affine", 1, ecc(of)},
                            {"phase correlation", 2, phase_correlation(of)}};
    if (!visp_program.empty()) {
        const auto child = std::make_shared<ChildDetector>(visp_program, of.scene.size_px(), of.scene.tag_id);
        peers.push_back({"ViSP's detector", 1, [child](const Trial& trial) -> std::optional<Estimate> {
                             const ChildDetector::Answer answer = child->ask(trial.frame);
                             if (answer.corners.size() != 4) return std::nullopt;
                             return Estimate{crossing(answer.corners), std::nullopt, answer.took_ms};
                         }});
    }
    return peers;
}

}  // namespace fidservo::bench
