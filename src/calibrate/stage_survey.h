// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The moves of a stage calibration, and what camera and sensors say at rest after each.
//
//   growing   half a view off the end stops, about where homing left the camera, the carriage moves 0.1, 0.2,
//             0.4 ... mm to either side until the next step would take the first tag out of the image
//   travel    stands over the whole travel, at uneven places of the tags' pitch
//   extended  heater off until the platform has relaxed: zero of the platform's travel
//   platform  from there the platform over its travel, up and down, the carriage at rest
//   fresh     moves of both kinds at other places, for checking what was fitted to the others
#include "calib/stage/stage_map.h"
#include "core/result.h"
#include "src/session/pilot.h"
#include "vision/tags/tag_detector.h"

#include <functional>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo {

enum class StageMove { growing, travel, extended, platform, fresh_travel, fresh_platform };

std::string_view name_of(StageMove move);

/// The measurements at one stand.
struct StageShot {
    StageMove move;
    double time_s;
    calib::StageView tags;
    double count;               ///< the encoder's count
    std::vector<int> hall_adc;  ///< readings around the time of exposure
    cv::Mat image;              ///< for refining the tags again; may be empty
    double hall_mean() const;
};

/// Refines the tags of all shots again, with a camera whose distortion is known by now, so that their edges
/// are modelled. A tag whose refinement fails is left out.
void refine_again(const CameraParameters& rig_camera, const CameraGeometry& camera,
                  std::vector<StageShot>& shots);

/// The number of stands of each kind.
struct StagePlan {
    bool growing = true;
    int travel = 28;
    int platform_up = 14, platform_down = 10;
    int fresh_travel = 8;
    int fresh_platform = 8;
};

/// Few moves, for a health check.
inline constexpr StagePlan quick_plan{false, 10, 6, 5, 0, 0};

class StageSurvey {
  public:
    /// @param pilot  a homed one
    StageSurvey(Pilot& pilot, const StagePlan& plan);

    /// All moves, in the order above. Fails with Reason::no_tag if tags are missing at more than a third of
    /// the stands over the travel, or with the failure of a motion or a device.
    /// @param on_shot  called after each stand
    Result<std::vector<StageShot>> run(const std::function<void()>& on_shot);
    /// Expected number of stands of a run.
    std::size_t expected_shots() const;

  private:
    struct Way {
        double low_mm, high_mm;
    };

    /// The camera positions at which the carriage keeps clear of its end stops, whatever the encoder's scale.
    Way clear_way() const;
    Status tick();
    Status wait(double duration_s);
    Result<StageShot> shoot(StageMove move);
    Status keep(Result<StageShot> shot);
    Result<calib::StageView> tags_in(const vision::Frame& frame);

    Status grow();
    Status grow_to(double side, const StageShot& first);
    Status travel(StageMove move, int stands, double phase);
    Status move_platform(double to_mm);
    Status relax();
    Status sweep_platform();

    Pilot& pilot_;
    StagePlan plan_;
    vision::TagDetector detector_;
    control::StageSample sample_{};
    std::vector<StageShot> shots_;
    std::function<void()> on_shot_;
};

}  // namespace fidservo
