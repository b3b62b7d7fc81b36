// SPDX-License-Identifier: GPL-3.0-or-later
// fidservo calibrate camera: a lens and a sensor's noise from images of a target.
#include "src/calibrate/calibrate_camera.h"

#include "src/cli/commands.h"

#include <memory>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace fidservo {

void add_calibrate_camera(CLI::App& parent, int& exit_code) {
    auto options = std::make_shared<CalibrateCameraOptions>();
    CLI::App* command =
        parent.add_subcommand("camera", "Focal length, principal point, distortion and noise of a camera");
    command
        ->add_option("INPUT", options->inputs,
                     "Images of a target, tilted this way and that: folders, recordings, videos, images")
        ->required()
        ->option_text("...");
    command
        ->add_option("--target", options->target_file,
                     "The target: an AprilGrid as kalibr's YAML describes it")
        ->type_name("TARGET.yaml");
    command
        ->add_option("--grid", options->grid,
                     "The target: an AprilGrid of so many tags; else the rig's plate")
        ->type_name("COLUMNSxROWS");
    command->add_option("--tag-size-mm", options->tag_size_mm, "Side of the grid's tags")->type_name("MM");
    command->add_option("--tag-spacing", options->tag_spacing, "Gap between them as a share of the side")
        ->type_name("SHARE");
    command->add_option("--lens", options->lens, "Model of the lens: plumb_bob, or equidistant for a fisheye")
        ->type_name("MODEL")
        ->capture_default_str();
    command->add_flag("--focal-ratio", options->focal_ratio, "Pixels may not be square: find f_y / f_x too");
    command
        ->add_option("--max-error-px", options->limits.most_rms_px,
                     "Reprojection error of a good calibration")
        ->type_name("PX")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--noise-frames", options->noise_frames,
                     "Frames of one scene at rest, for the noise; else repeats among the images")
        ->type_name("DIR");
    add_rig_option(*command, options->rig_file);
    command->add_option("--camera-info", options->camera_info, "New ROS camera_info file")
        ->type_name("FILE.yaml");
    command->add_option("--write-rig", options->write_rig, "New rig file with the camera's values")
        ->type_name("FILE.yaml");
    command->add_option("--report", options->report, "New report")->type_name("FILE.html");
    add_example(
        *command,
        "fidservo calibrate camera photos/ --grid 6x6 --tag-size-mm 88 --tag-spacing 0.3 --camera-info "
        "camera.yaml");
    command->callback([options, &exit_code] { exit_code = calibrate_camera(*options); });
}

}  // namespace fidservo
