// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Everything that reads a file, as functions of the file's bytes: for a fuzzer, and for the corpus in a plain
// test.
#include <array>
#include <string_view>

namespace fidservo::fuzz {

/// Passes the bytes to a reader as a file. InputError is a valid result; any other exception is not caught.
using Target = void (*)(std::string_view bytes);

void read_rig(std::string_view bytes);
void read_recipe(std::string_view bytes);
void read_experiment(std::string_view bytes);
/// Effects as formulas, which are evaluated, too.
void read_effects(std::string_view bytes);
void read_plate(std::string_view bytes);
/// recording.yaml, stage0/data.csv, cam0/data.csv and cam0/detections.csv, between lines "%%%".
void read_recording(std::string_view bytes);
void read_camera_info(std::string_view bytes);
/// kalibr's file of a calibration target.
void read_camera_target(std::string_view bytes);
void read_image(std::string_view bytes);
/// The pages of a TIFF.
void read_stack(std::string_view bytes);
void read_video(std::string_view bytes);
/// A text table as `identify --table` reads it, with and without what its options say, and a table of
/// first-order descending curves.
void read_table(std::string_view bytes);
/// A list of images and times as another program writes it.
void read_frame_index(std::string_view bytes);
void read_journal(std::string_view bytes);
/// Other programs' logs, read by their libraries in a process of their own, as in the program.
void read_mat(std::string_view bytes);
void read_hdf5(std::string_view bytes);
/// A bag of ROS 2 with its frames.
void read_bag(std::string_view bytes);
/// A map of an import, and its result for a small log.
void read_import_map(std::string_view bytes);
/// A text table read as by an import, and the map that is drafted for it.
void read_table_log(std::string_view bytes);

struct NamedTarget {
    std::string_view name;  ///< name of the fuzzer, and of its folder in corpus/
    Target target;
};

inline constexpr std::array targets{
    NamedTarget{"rig", read_rig},
    NamedTarget{"recipe", read_recipe},
    NamedTarget{"experiment", read_experiment},
    NamedTarget{"effects", read_effects},
    NamedTarget{"plate", read_plate},
    NamedTarget{"recording", read_recording},
    NamedTarget{"camera_info", read_camera_info},
    NamedTarget{"camera_target", read_camera_target},
    NamedTarget{"image", read_image},
    NamedTarget{"stack", read_stack},
    NamedTarget{"video", read_video},
    NamedTarget{"table", read_table},
    NamedTarget{"frame_index", read_frame_index},
    NamedTarget{"journal", read_journal},
    NamedTarget{"mat", read_mat},
    NamedTarget{"hdf5", read_hdf5},
    NamedTarget{"bag", read_bag},
    NamedTarget{"import_map", read_import_map},
    NamedTarget{"table_log", read_table_log},
};

}  // namespace fidservo::fuzz
