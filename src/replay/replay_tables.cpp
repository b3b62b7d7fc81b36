// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/replay/replay_tables.h"

#include "core/input_error.h"
#include "core/result.h"
#include "src/files/recording/layout.h"
#include "src/files/recording/row_format.h"

#include <utility>

#include <fmt/format.h>

namespace fidservo {

namespace {

void check(const Status& status) {
    if (!status) throw RunFault(status.error().text);
}

DurableFile create(const std::filesystem::path& file) {
    auto created = DurableFile::create(file);
    if (!created) throw RunFault(created.error().text);
    return *std::move(created);
}

/// A field that holds any file name: quoted where it must be.
std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char letter : text) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
    return quoted + '"';
}

}  // namespace

std::string detection_row(const TagDetection& tag) {
    std::string row = fmt::format("{}", tag.tag_id);
    append_corners(row, tag, CornerColumns::places_and_covariances);
    return row;
}

ReplayTables::ReplayTables(const std::filesystem::path& folder, bool with_times)
    : with_times_(with_times),
      detections_(create(folder / "detections.csv")),
      displacements_(create(folder / "displacements.csv")) {
    const std::string key = fmt::format("#{},tag_id", with_times ? time_title : "image");
    check(detections_.append(
        fmt::format("{},{}\n", key, corners_header(CornerColumns::places_and_covariances))));
    check(displacements_.append(key + ",dx [um],dy [um],dx_std [um],dy_std [um]\n"));
}

void ReplayTables::add(const ImageFrame& frame, std::span<const std::string> detections,
                       std::span<const vision::Displacement> displacements) {
    const std::string key = with_times_ ? fmt::format("{}", frame.time_ns.value()) : csv_field(frame.name);
    std::string text;
    for (const std::string& row : detections) text += fmt::format("{},{}\n", key, row);
    check(detections_.append(text));
    text.clear();
    for (const vision::Displacement& tag : displacements)
        text += fmt::format("{},{},{:.3f},{:.3f},{:.3f},{:.3f}\n", key, tag.tag_id, tag.moved_um.x(),
                            tag.moved_um.y(), tag.std_um.x(), tag.std_um.y());
    check(displacements_.append(text));
}

void ReplayTables::close() {
    check(detections_.close());
    check(displacements_.close());
}

}  // namespace fidservo
