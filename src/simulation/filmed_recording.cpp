// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/simulation/filmed_recording.h"

#include "core/input_error.h"
#include "core/result.h"
#include "core/rig.h"
#include "src/files/recording/writer.h"
#include "src/simulation/experiment_law.h"
#include "src/simulation/run_experiment.h"
#include "src/simulation/simulate.h"

namespace fidservo {

namespace {

void check(const Status& status) {
    if (!status) throw RunFault(status.error().text);
}

}  // namespace

void write_filmed_recording(const std::filesystem::path& folder, const Rig& rig,
                            std::span<const plant::EffectSetting> effects, const Experiment& experiment,
                            const std::string& name, std::uint64_t seed, const RecordingOrigin& origin) {
    RecordingWriter writer(folder, {.name = name,
                                    .rig = rig.name,
                                    .experiment = experiment.kind,
                                    .tick_s = rig.tick_s,
                                    .encoder_zero = simulated_zero(),
                                    .controllers = controllers_of(experiment),
                                    .origin = origin,
                                    .columns = columns_of(rig),
                                    .camera = rig.camera,
                                    .corners = CornerColumns::places_and_covariances,
                                    .frames = true,
                                    .when_full = WhenFull::wait});
    const Recording recording =
        simulate(rig, effects, experiment, name, seed,
                 [&](TimeNs stamp_ns, const cv::Mat& image) { check(writer.add_frame(stamp_ns, image)); });
    for (const StageRow& row : recording.rows) check(writer.add(row));
    for (const TagDetection& detection : recording.detections) check(writer.add(detection));
    check(writer.close());
}

}  // namespace fidservo
