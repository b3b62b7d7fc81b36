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
    fail,  ///< fail at once, so that the run stops safely: for a real stage
    wait,  ///< wait until there is room: for a simulation, which can be faster than any disk
};

/// What a recording states about itself, and what it contains.
struct RecordingOptions {
    std::string name;                                 ///< of the recording
    std::string rig;                                  ///< name of the rig, as the rig file states it
    std::string experiment;                           ///< what is done, in words
    double tick_s = 0.001;                            ///< time from row to row
    std::optional<EncoderZero> encoder_zero = {};     ///< as far as it is known at the start
    std::optional<ControllerNames> controllers = {};  ///< empty: not stated
    RecordingOrigin origin = {};                      ///< the stage, camera and program that make it
    std::vector<PlateTag> plate = {};                 ///< written to plate.yaml; empty: the rig file's plate
    StageColumns columns;                             ///< the columns to be written
    std::optional<CameraParameters> camera;  ///< written to cam0/sensor.yaml; detections are recorded, too
    bool detections = false;                 ///< detections are recorded although no camera is given
    CornerColumns corners = CornerColumns::places;  ///< what is written of a detection's corners
    bool frames = false;                            ///< images are kept
    double ring_s = 12.0;                           ///< longest time for which the disk may stall
    WhenFull when_full = WhenFull::fail;            ///< what to do when the ring is full
};

/// The columns that a rig's recordings have.
StageColumns columns_of(const Rig& rig);

/// Writes a recording folder during a run.
class RecordingWriter {
  public:
    /// Makes the folder, which must not exist, and starts the writing thread. Throws InputError.
    RecordingWriter(const std::filesystem::path& folder, const RecordingOptions& options);
    /// If the recording was not closed, leaves it unfinished, with everything that was added.
    ~RecordingWriter();
    RecordingWriter(const RecordingWriter&) = delete;
    RecordingWriter& operator=(const RecordingWriter&) = delete;

    // For one thread at a time. These neither allocate nor wait (with WhenFull::fail). They fail with
    // Reason::device once the disk has failed or the ring is full; nothing was lost up to then.
    /// Adds a tick, in the order of time.
    Status add(const StageRow& row);
    /// Adds a detection, in the order of time.
    Status add(const TagDetection& detection);
    /// Keeps a frame as cam0/data/TIME.png. The image is shared, not copied: do not write to it afterwards.
    Status add_frame(TimeNs time_ns, const cv::Mat& image);

    // Further statements in recording.yaml, which is written at the end. These may allocate.
    /// Adds an event.
    void add(RecordingEvent event);
    /// Sets the encoder's zero as it is known at the end.
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
