// SPDX-License-Identifier: GPL-3.0-or-later
#include "calib/hall/hall_curve.h"
#include "core/input_error.h"
#include "core/rig.h"
#include "src/files/rig/plate_file.h"
#include "src/identify/identify.h"
#include "vision/camera_position.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace fidservo {

namespace {

/// Where the camera is, by the corners of a tag; NaN if the tag is not on the plate.
double camera_mm(const Rig& rig, const std::vector<PlateTag>& plate, const TagDetection& seen) {
    const auto tag = std::ranges::find(plate, seen.tag_id, &PlateTag::id);
    if (tag == plate.end()) return not_in_force;
    return vision::fit_position(rig.camera->geometry, *tag, vision::unrefined(seen)).position.s_mm;
}

/// Mean reading over an exposure; NaN outside the recording.
double mean_adc(const Recording& recording, TimeNs middle_ns, double exposure_s) {
    const TimeNs half = nanoseconds(0.5 * exposure_s);
    double sum = 0.0, count = 0.0;
    const auto first = std::ranges::lower_bound(recording.rows, middle_ns - half, {}, &StageRow::time_ns);
    for (auto row = first; row != recording.rows.end() && row->time_ns <= middle_ns + half; ++row) {
        sum += row->hall_adc;
        count += 1.0;
    }
    return count > 0.0 ? sum / count : not_in_force;
}

/// The carriage must rest: then the camera moves with the platform. Zero is where it starts, fully extended.
void append_sights(const Rig& rig, const std::vector<PlateTag>& plate, const Recording& recording,
                   std::vector<calib::HallSample>& samples) {
    constexpr double rest_s = 0.05;
    constexpr double rest_mm = 0.02;
    const double carriage = recording.rows.front().encoder_count;
    const bool rests = std::ranges::all_of(
        recording.rows, [&](const StageRow& row) { return !(row.encoder_count != carriage); });
    if (!rests || recording.detections.empty()) return;
    const double rest_adc =
        mean_adc(recording, recording.rows.front().time_ns + nanoseconds(0.5 * rest_s), rest_s);
    const double near_lsb =
        rest_mm / (rig.micro->hall.half_range_mm / rig.micro->hall.span_V) / hall_lsb_V(rig.micro->hall);
    std::vector<calib::HallSample> seen;
    double zero_mm = 0.0, at_rest = 0.0;
    for (const TagDetection& detection : recording.detections) {
        const calib::HallSample sample{camera_mm(rig, plate, detection),
                                       mean_adc(recording, detection.time_ns, rig.camera->exposure_s)};
        if (!std::isfinite(sample.reference_mm) || !std::isfinite(sample.adc)) continue;
        if (std::abs(sample.adc - rest_adc) < near_lsb && at_rest == static_cast<double>(seen.size())) {
            zero_mm += sample.reference_mm;
            at_rest += 1.0;
        }
        seen.push_back(sample);
    }
    if (at_rest == 0.0) return;
    for (calib::HallSample& sample : seen) {
        sample.reference_mm -= zero_mm / at_rest;
        samples.push_back(sample);
    }
}

void append_positions(const Recording& recording, std::vector<calib::HallSample>& samples) {
    for (const StageRow& row : recording.rows)
        if (std::isfinite(row.position_mm) && std::isfinite(row.hall_adc))
            samples.push_back({row.position_mm, row.hall_adc});
}

std::vector<calib::HallSample> samples_of(const IdentifyInput& input, Identified& identified) {
    std::vector<calib::HallSample> samples;
    if (input.table) {
        identified.recordings = {input.table->file.string()};
        const std::vector<double> reference_mm = values_in(*input.table, "input", "mm");
        const std::vector<double> adc = values_in(*input.table, "output", "adc");
        for (std::size_t k = 0; k < adc.size(); ++k) samples.push_back({reference_mm[k], adc[k]});
        return samples;
    }
    std::vector<PlateTag> of_rig;
    if (input.rig.fiducials) of_rig = plate_of(*input.rig.fiducials).tags;
    for (const Recording& recording : input.recordings) {
        const std::size_t before = samples.size();
        if (!recording.columns.hall) continue;
        if (recording.columns.position)
            append_positions(recording, samples);
        else if (input.rig.camera)
            append_sights(input.rig, recording.plate.empty() ? of_rig : recording.plate, recording, samples);
        if (samples.size() > before) identified.recordings.push_back(recording.name);
    }
    if (samples.empty())
        throw InputError(
            "no recording has hall [adc] with a reference: position [mm], or tags seen from a carriage at "
            "rest whose "
            "platform starts at rest; a table of displacement and reading is read with --table");
    return samples;
}

}  // namespace

Identified calibrate_hall(const IdentifyInput& input) {
    if (!input.rig.micro)
        throw InputError(fmt::format("the rig {} has no Hall sensor to calibrate", input.rig.name));
    const MicroParameters& micro = *input.rig.micro;
    Identified identified{.part = "hall"};
    const std::vector<calib::HallSample> samples = samples_of(input, identified);
    const auto curve = calib::fit_hall_curve(micro.hall, samples, micro.low_mm, micro.high_mm);
    if (!curve) {
        for (const char* key : {"mid_V", "span_V", "centre_mm", "cubic"})
            identified.undetermined.push_back({fmt::format("micro.hall.{}", key), curve.error().text});
        return identified;
    }
    identified.values = {{"micro.hall.mid_V", "V", curve->hall.mid_V, curve->mid_std_V},
                         {"micro.hall.span_V", "V", curve->hall.span_V, curve->span_std_V}};
    if (curve->refused) {
        identified.undetermined = {{"micro.hall.centre_mm", curve->refused->text},
                                   {"micro.hall.cubic", curve->refused->text}};
    } else {
        identified.values.push_back(
            {"micro.hall.centre_mm", "mm", curve->hall.centre_mm, curve->centre_std_mm});
        identified.values.push_back({"micro.hall.cubic", "", curve->hall.cubic, curve->cubic_std});
    }
    identified.residuals = {
        {"hall", "adc", curve->residual_lsb, std::hypot(micro.hall.noise_lsb, 1.0 / std::sqrt(12.0))}};
    identified.notes.push_back(
        fmt::format("resolution over the travel: {:.4g} um per bit on average, {:.4g} at the steepest, "
                    "{:.4g} at the flattest",
                    curve->mean_um_per_bit, curve->finest_um_per_bit, curve->coarsest_um_per_bit));
    identified.notes.push_back(
        fmt::format("{} readings, references {:.4g} to {:.4g} mm; {} saturated left out", curve->samples,
                    curve->low_mm, curve->high_mm, curve->saturated));
    return identified;
}

}  // namespace fidservo
