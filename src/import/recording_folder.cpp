// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/recording_folder.h"

#include "core/input_error.h"
#include "src/files/disk/durable_file.h"
#include "src/files/recording/row_format.h"
#include "src/files/rig/plate_file.h"
#include "src/images/grey_range.h"
#include "src/import/interrupted.h"
#include "vision/images/image_file.h"

#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace fidservo::imports {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& folder) {
    std::error_code error;
    const bool is = fs::exists(folder, error);
    if (error)
        throw InputError(fmt::format("--out: {}: cannot be made: {}", folder.string(), error.message()));
    return is;
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw InputError(fmt::format("--out: {}: cannot be made: {}", folder.string(), error.message()));
}

LoggedFrame frame_of(const Assembled& made, std::size_t k) {
    end_if_interrupted();
    auto frame = made.camera->frame(k);
    end_if_interrupted();
    if (!frame) throw InputError(fmt::format("{}: frame {}: {}", made.camera->name, k + 1, frame.error()));
    return *std::move(frame);
}

/// The bits in use, by the rule for all sequences of images (grey_range.h).
int bits_of_frames(const Assembled& made) {
    GreyLevels levels;
    if (made.camera->is_deep)
        for (std::size_t k = 0; k < made.frame_times_ns.size(); ++k) levels.add(frame_of(made, k).image);
    if (!levels.is_empty()) spdlog::info("{}: {}", made.camera->name, levels.text());
    return levels.bits();
}

void write_frames(const fs::path& folder, const Assembled& made) {
    constexpr int fast_compression = 1;
    make_folder(folder / "data");
    const int bits = bits_of_frames(made);
    std::string index = frames_header();
    for (std::size_t k = 0; k < made.frame_times_ns.size(); ++k) {
        const LoggedFrame frame = frame_of(made, k);
        const std::string ending = frame.ending.empty() ? ".png" : frame.ending;
        const FrameName name{made.frame_times_ns[k], fmt::format("{}{}", made.frame_times_ns[k], ending)};
        if (frame.bytes.empty()) {
            const std::vector<unsigned char> png =
                vision::encode_png(vision::to_8_bits(frame.image, bits), fast_compression);
            write_or_throw(folder / "data" / name.filename,
                           {reinterpret_cast<const char*>(png.data()), png.size()});
        } else {
            if (const auto image = vision::decode_stored(frame.bytes); !image)
                throw InputError(
                    fmt::format("{}: frame {}: {}", made.camera->name, k + 1, image.error().text));
            write_or_throw(folder / "data" / name.filename, frame.bytes);
        }
        append_frame(index, name);
    }
    write_or_throw(folder / "data.csv", index);
}

void write_files(const fs::path& folder, const Assembled& made,
                 const std::optional<CameraParameters>& camera) {
    const Recording& recording = made.recording;
    make_folder(folder);
    write_or_throw(folder / "recording.yaml", description_yaml(recording, made.origin));
    if (!recording.plate.empty()) write_or_throw(folder / "plate.yaml", plate_yaml(recording.plate));
    if (!recording.rows.empty()) {
        end_if_interrupted();
        make_folder(folder / "stage0");
        write_or_throw(folder / "stage0/data.csv", stage_text(recording, made.decimals));
    }
    if (!recording.detections.empty() || camera) {
        make_folder(folder / "cam0");
        write_or_throw(folder / "cam0/detections.csv", detections_text(recording.detections));
    }
    if (camera) write_or_throw(folder / "cam0/sensor.yaml", sensor_yaml(*camera));
    if (made.camera != nullptr) write_frames(folder / "cam0", made);
    if (!made.camera_info.empty()) write_or_throw(folder / "camera_info.yaml", made.camera_info);
}

}  // namespace

void write_folder(const fs::path& folder, const Assembled& made,
                  const std::optional<CameraParameters>& camera) {
    if (is_there(folder))
        throw InputError(fmt::format("--out: {}: exists already; nothing is overwritten", folder.string()));
    fs::path unfinished = folder.lexically_normal();
    if (!unfinished.has_filename()) unfinished = unfinished.parent_path();
    const fs::path finished = unfinished;
    unfinished += ".unfinished";
    if (is_there(unfinished))
        throw InputError(
            fmt::format("--out: {}: is left of a run that was killed; remove it", unfinished.string()));
    std::error_code error;
    try {
        write_files(unfinished, made, camera);
        fs::rename(unfinished, finished, error);
        if (error) throw RunFault(fmt::format("{}: cannot be named: {}", folder.string(), error.message()));
    } catch (...) {
        fs::remove_all(unfinished, error);
        throw;
    }
}

}  // namespace fidservo::imports
