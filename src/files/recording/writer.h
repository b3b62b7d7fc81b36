// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Writes a recording folder while it is being made: the control loop hands over rows without waiting, a
// thread formats and writes them.
#include "core/camera/camera_parameters.h"
#include "core/recording.h"
#include "core/result.h"
#include "src/files/recording/description.h"
#include "src/files/recording/row_format.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace fidservo {

struct Rig;

/// What to do when the disk is slower than the loop and the ring is full.
enum class WhenFull {
    fail,  ///< say so at once: the run must stop safely; on a real stage
    wait,  ///< until there is room; in simulation, which can be faster than any disk
};

/// What a recording says of itself.
struct RecordingOptions {
    std::string name;                                 ///< of the recording
    std::string rig;                                  ///< by the rig file's name
    std::string experiment;                           ///< what is done, in words
    double tick_s = 0.001;                            ///< from row to row
    std::optional<EncoderZero> encoder_zero = {};     ///< as far as it is known at the start
    std::optional<ControllerNames> controllers = {};  ///< empty: not stated
    RecordingOrigin origin = {};                      ///< by which stage, camera and program it is made
    std::vector<PlateTag> plate = {};                 ///< gives plate.yaml; empty: the rig file's
    StageColumns columns;                             ///< to be written
    std::optional<CameraParameters> camera;           ///< gives cam0/sensor.yaml and detections.csv
    bool detections = false;                          ///< to be added although no camera is given
    CornerColumns corners = CornerColumns::places;    ///< what is written of a detection's corners
    bool frames = false;                              ///< to be kept as images
    double ring_s = 12.0;                             ///< how long the disk may stall
    WhenFull when_full = WhenFull::fail;              ///< what to do when the ring is full
};

/// The columns that a rig's recordings have.
StageColumns columns_of(const Rig& rig);

/// A recording folder in the making.
class RecordingWriter {
  public:
    /// Makes the folder, which must not exist, and starts the writing thread. Throws InputError.
    RecordingWriter(const std::filesystem::path& folder, const RecordingOptions& options);
    /// Leaves a recording that was not closed as unfinished, with all that was handed over.
    ~RecordingWriter();
    RecordingWriter(const RecordingWriter&) = delete;
    RecordingWriter& operator=(const RecordingWriter&) = delete;

    // One thread at a time may call these. They neither allocate nor wait (WhenFull::fail). They fail with
    // Reason::device once the disk has failed or the ring is full: nothing was lost up to then.
    /// A tick, after those before it.
    Status add(const StageRow& row);
    /// A tag, after those before it.
    Status add(const TagDetection& detection);
    /// Keeps a frame as cam0/data/TIME.png. The image is shared, not copied: do not write to it afterwards.
    Status add_frame(TimeNs time_ns, const cv::Mat& image);

    // What recording.yaml states besides; written at the end. These may allocate.
    /// Something that happened.
    void add(RecordingEvent event);
    /// As it is known by then.
    void set_encoder_zero(const EncoderZero& zero);

    /// Writes all that was handed over, waits until the disk has it, and states that the recording is
    /// finished. Fails with Reason::device.
    Status close();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Writes a recording that is complete in memory (its frames are names only and are not written). Throws
/// InputError if the folder exists, RunFault if the disk fails.
void write_recording(const std::filesystem::path& folder, const Recording& recording,
                     const std::optional<CameraParameters>& camera, const RecordingOrigin& origin = {});

}  // namespace fidservo
