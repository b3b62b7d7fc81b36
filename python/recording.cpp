// SPDX-License-Identifier: GPL-3.0-or-later
// Recording: columns as arrays, without a copy.
#include "python/bindings.h"
#include "src/files/recording/layout.h"
#include "src/files/recording/reader.h"
#include "src/files/recording/writer.h"
#include "src/import/assemble.h"
#include "src/import/draft_map.h"
#include "src/import/export_log.h"

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace fidservo::python {

namespace py = pybind11;

namespace {

/// The detections of a recording, which it keeps.
struct HeldDetections {
    RecordingPointer held;

    const std::vector<TagDetection>& tags() const { return held->recording.detections; }
    py::ssize_t size() const { return static_cast<py::ssize_t>(tags().size()); }
    /// A field of the first one; of none, of a detection that is never looked at.
    const TagDetection& first() const {
        static const TagDetection none;
        return tags().empty() ? none : tags().front();
    }
};

RecordingPointer read(const std::filesystem::path& folder) {
    return std::make_shared<HeldRecording>(HeldRecording{read_recording(folder), folder, {}});
}

std::vector<RecordingPointer> read_all(const std::filesystem::path& path) {
    const py::gil_scoped_release others_may_run;
    std::vector<RecordingPointer> all;
    for (const std::filesystem::path& folder : find_recordings(path)) all.push_back(read(folder));
    return all;
}

/// Whole numbers of 64 bits are kept exactly, all else as doubles.
imports::LoggedSignal signal_of(const std::string& name, const py::array& values) {
    if (values.ndim() != 1)
        throw py::value_error(name + ": has " + std::to_string(values.ndim()) + " dimensions; must have one");
    if (std::string_view("iufb").find(values.dtype().kind()) == std::string_view::npos)
        throw py::type_error(name + ": must hold numbers");
    imports::LoggedSignal signal{.name = name};
    const auto numbers = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(values);
    signal.values.assign(numbers.data(), numbers.data() + numbers.size());
    if (values.dtype().kind() == 'i' && values.itemsize() == sizeof(std::int64_t)) {
        const auto whole = py::array_t<std::int64_t, py::array::c_style>::ensure(values);
        signal.whole.assign(whole.data(), whole.data() + whole.size());
    }
    return signal;
}

std::vector<imports::Log> log_of(const std::map<std::string, py::array>& arrays) {
    imports::Log log{.file = "arrays"};
    for (const auto& [name, values] : arrays) log.signals.push_back(signal_of(name, values));
    return {std::move(log)};
}

RecordingPointer from_arrays(const std::map<std::string, py::array>& arrays, const std::string& map) {
    imports::Assembled made = imports::assemble(log_of(arrays), imports::parse_import_map(map, "map"));
    return std::make_shared<HeldRecording>(
        HeldRecording{std::move(made.recording), {}, std::move(made.notes)});
}

void write(const HeldRecording& held, const std::filesystem::path& folder, const HeldRig* rig) {
    const py::gil_scoped_release others_may_run;
    write_recording(folder, held.recording, rig == nullptr ? std::nullopt : rig->rig.camera);
}

std::vector<std::string> column_names(const HeldRecording& held) {
    std::vector<std::string> names;
    for (const StageColumn& column : stage_columns)
        if (held.recording.columns.*column.present) names.push_back(imports::exported_name(column.title));
    return names;
}

/// A field of all rows.
template <class Value>
py::array rows_view(const py::object& self, Value StageRow::*field) {
    const std::vector<StageRow>& rows = self.cast<const HeldRecording&>().recording.rows;
    static const StageRow none;
    const StageRow& first = rows.empty() ? none : rows.front();
    return view(&(first.*field), {static_cast<py::ssize_t>(rows.size())}, {sizeof(StageRow)}, self);
}

py::array column(const py::object& self, const std::string& name) {
    const auto& held = self.cast<const HeldRecording&>();
    for (const StageColumn& column : stage_columns)
        if (held.recording.columns.*column.present && imports::exported_name(column.title) == name)
            return rows_view(self, column.value);
    throw py::key_error(name);
}

py::array corners(const py::object& self) {
    const auto& held = self.cast<const HeldDetections&>();
    return view(held.first().corners_px.front().data(), {held.size(), 4, 2},
                {sizeof(TagDetection), sizeof(Eigen::Vector2d), sizeof(double)}, self);
}

/// NaN where corners were not measured.
py::array_t<double> covariances(const HeldDetections& held) {
    py::array_t<double> all({held.size(), py::ssize_t{4}, py::ssize_t{2}, py::ssize_t{2}});
    double* next = all.mutable_data();
    const Eigen::Matrix2d unknown = Eigen::Matrix2d::Constant(std::numeric_limits<double>::quiet_NaN());
    for (const TagDetection& tag : held.tags())
        for (std::size_t corner = 0; corner < 4; ++corner, next += 4)
            Eigen::Map<Eigen::Matrix2d>{next} =
                tag.covariances_px2 ? (*tag.covariances_px2)[corner] : unknown;
    return all;
}

void bind_detections(py::module_& module) {
    py::class_<HeldDetections>(module, "Detections",
                               "The fiducials that the camera saw, one each, by time. Arrays are read-only.")
        .def("__len__", &HeldDetections::size)
        .def_property_readonly(
            "time_ns",
            [](const py::object& self) {
                const auto& held = self.cast<const HeldDetections&>();
                return view(&held.first().time_ns, {held.size()}, {sizeof(TagDetection)}, self);
            },
            "Middle of the frame's exposure, ns.")
        .def_property_readonly(
            "tag_id",
            [](const py::object& self) {
                const auto& held = self.cast<const HeldDetections&>();
                return view(&held.first().tag_id, {held.size()}, {sizeof(TagDetection)}, self);
            },
            "By the family's code book.")
        .def_property_readonly("corners_px", &corners,
                               "n x 4 x 2, px: u and v of the corners, pixel centres at integers, in the "
                               "order (-,+), (+,+), (+,-), (-,-) in plate x, y.")
        .def_property_readonly("covariances_px2", &covariances,
                               "n x 4 x 2 x 2, px^2: of each corner; NaN where it was not measured. A copy.");
}

}  // namespace

void bind_recording(py::module_& module) {
    bind_detections(module);
    py::class_<HeldRecording, std::shared_ptr<HeldRecording>>(
        module, "Recording",
        "A recording: a row per tick, and the fiducials seen. recording['encoder_count'] is a column as a "
        "read-only array without a copy; NaN is 'not in force'. It never changes.")
        .def_static("read", &read, py::arg("folder"), py::call_guard<py::gil_scoped_release>(),
                    "Reads a recording folder. Raises InputError that names file and line.")
        .def_static(
            "from_arrays", &from_arrays, py::arg("arrays"), py::arg("map"),
            "A recording out of arrays of one dimension, by name, as `fidservo import` makes one of a "
            "file. `map` is the text of a map (format fidservo-map/1, docs/import.md) that says which "
            "array is what, in which unit. Raises InputError.")
        .def("write", &write, py::arg("folder"), py::arg("rig") = nullptr,
             "Writes a new recording folder. `rig`: whose camera saw the fiducials; its intrinsics are "
             "written, "
             "too. Raises InputError if the folder exists, RunFault if the disk fails.")
        .def_property_readonly(
            "name", [](const HeldRecording& held) { return held.recording.name; }, "Of the recording.")
        .def_property_readonly(
            "rig", [](const HeldRecording& held) { return held.recording.rig; }, "The rig's name.")
        .def_property_readonly(
            "experiment", [](const HeldRecording& held) { return held.recording.experiment; },
            "What was done, in words.")
        .def_property_readonly(
            "tick_s", [](const HeldRecording& held) { return held.recording.tick_s; }, "From row to row, s.")
        .def_readonly("notes", &HeldRecording::notes, "How it was made of arrays, a sentence each.")
        .def_property_readonly("columns", &column_names, "The names of its columns, with their units.")
        .def_property_readonly(
            "time_ns", [](const py::object& self) { return rows_view(self, &StageRow::time_ns); },
            "When each row was sampled, ns, on one clock.")
        .def_property_readonly(
            "detections", [](RecordingPointer held) { return HeldDetections{std::move(held)}; },
            "The fiducials that the camera saw.")
        .def("__getitem__", &column, py::arg("column"))
        .def("__len__", [](const HeldRecording& held) { return held.recording.rows.size(); })
        .def("__repr__", [](const HeldRecording& held) {
            return "<Recording '" + held.recording.name + "' of " + held.recording.rig + ", " +
                   std::to_string(held.recording.rows.size()) + " rows>";
        });
    module.def(
        "read_recordings", &read_all, py::arg("path"),
        "The recordings that a path stands for, by name: itself, those in it, or those of a run's folder. "
        "Raises InputError if there are none.");
    module.def(
        "draft_map",
        [](const std::map<std::string, py::array>& arrays) { return imports::draft_map(log_of(arrays)); },
        py::arg("arrays"),
        "A map to edit for Recording.from_arrays, under comments that list every array with its count, rate "
        "and range.");
}

}  // namespace fidservo::python
