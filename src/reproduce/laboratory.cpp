// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/reproduce/laboratory.h"

#include "core/hall.h"
#include "core/rig.h"
#include "src/files/recording/writer.h"
#include "src/simulation/simulate_reference.h"

#include <algorithm>

namespace fidservo::reproduce {

Recording perform(const Laboratory& laboratory, const std::string& name, const Experiment& experiment,
                  const reference::Departures& departures) {
    Recording recording = simulate_reference(laboratory.rig, departures, experiment, name, laboratory.seed);
    write_recording(laboratory.out / "recordings" / name, recording, laboratory.rig.camera);
    return recording;
}

std::vector<double> platform_mm(const Rig& rig, const Recording& recording) {
    std::vector<double> positions(recording.rows.size());
    std::ranges::transform(recording.rows, positions.begin(), [&](const StageRow& row) {
        return hall_position_mm_of_adc(rig.micro->hall, row.hall_adc);
    });
    return positions;
}

std::vector<double> carriage_mm(const Rig& rig, const Recording& recording) {
    std::vector<double> positions(recording.rows.size());
    std::ranges::transform(recording.rows, positions.begin(), [&](const StageRow& row) {
        return rig.macro.encoder_resolution_mm * row.encoder_count;
    });
    return positions;
}

}  // namespace fidservo::reproduce
