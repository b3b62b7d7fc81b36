// SPDX-License-Identifier: GPL-3.0-or-later
// Recording: columns as arrays, without a copy.
#include "python/bindings.h"
#include "src/files/recording/layout.h"
#include "src/files/recording/reader.h"
#include "src/import/assemble.h"
#include "src/import/draft_map.h"
#include "src/import/export_log.h"
#include "src/import/recording_folder.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <new>
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
    /// The first detection, of which fields are referred to; without detections, a default one that is never
    /// read.
    const TagDetection& first() const {
        static const TagDetection none;
        return tags().empty() ? none : tags().front();
    }
};

RecordingPointer read(const std::filesystem::path& folder) {
    return held(read_recording(folder), read_origin(folder / "recording.yaml"), folder);
}

std::vector<RecordingPointer> read_all(const std::filesystem::path& path) {
    const py::gil_scoped_release others_may_run;
    std::vector<RecordingPointer> all;
    for (const std::filesystem::path& folder : find_recordings(path)) all.push_back(read(folder));
    return all;
}

/// The values as numbers of a type.
template <class Value>
std::vector<Value> numbers_in(const py::array& values) {
    const auto numbers = py::array_t<Value, py::array::c_style | py::array::forcecast>::ensure(values);
    if (!numbers) throw std::bad_alloc();
    return {numbers.data(), numbers.data() + numbers.size()};
}

/// Whether the values are whole numbers of 64 bits that all fit into signed ones.
bool are_whole(const py::array& values) {
    const char kind = values.dtype().kind();
    if (values.itemsize() != sizeof(std::int64_t)) return false;
    return kind == 'i' || (kind == 'u' && std::ranges::all_of(numbers_in<std::uint64_t>(values), [](auto n) {
                               return std::in_range<std::int64_t>(n);
                           }));
}

/// Whole numbers of 64 bits are kept exactly, all else as doubles; masked ones are missing.
imports::LoggedSignal signal_of(const std::string& name, const py::object& given) {
    const auto [values, mask] = array_of(name, given);
    if (std::string_view("iufb").find(values.dtype().kind()) == std::string_view::npos)
        throw py::type_error(name + ": holds " + std::string(py::str(values.dtype())) +
                             "; must hold numbers");
    if (values.ndim() != 1)
        throw py::value_error(name + ": has " + std::to_string(values.ndim()) + " dimensions; must have one");
    imports::LoggedSignal signal{.name = name, .values = numbers_in<double>(values)};
    if (mask) {
        for (py::ssize_t k = 0; k < mask->size(); ++k)
            if (mask->at(k)) signal.values[static_cast<std::size_t>(k)] = not_in_force;
    } else if (are_whole(values)) {
        signal.whole = numbers_in<std::int64_t>(values);
    }
    return signal;
}

/// A table of pandas is one of its columns, too.
py::dict dict_of(const py::object& arrays) {
    try {
        return {arrays};
    } catch (const py::error_already_set& error) {
        if (!error.matches(PyExc_TypeError) && !error.matches(PyExc_ValueError)) throw;
        throw py::type_error("arrays: must be a dict of arrays by name, not " + type_name(arrays));
    }
}

std::vector<imports::Log> log_of(const py::object& arrays) {
    std::map<std::string, py::object> by_name;
    for (const auto& [name, given] : dict_of(arrays)) {
        if (!py::isinstance<py::str>(name))
            throw py::type_error("arrays: must be a dict of arrays by name; has the name " +
                                 std::string(py::repr(name)));
        by_name[name.cast<std::string>()] = py::reinterpret_borrow<py::object>(given);
    }
    imports::Log log{.file = "arrays"};
    for (const auto& [name, given] : by_name) log.signals.push_back(signal_of(name, given));
    return {std::move(log)};
}

RecordingPointer from_arrays(const py::object& arrays, const py::object& map) {
    if (!py::isinstance<py::str>(map))
        throw py::type_error("map: must be the text of a map, not " + type_name(map));
    imports::Assembled made =
        imports::assemble(log_of(arrays), imports::parse_import_map(map.cast<std::string>(), "map"));
    imports::make_as_read(made.recording, made.decimals);
    return std::make_shared<HeldRecording>(std::move(made));
}

void write(const HeldRecording& held, const std::filesystem::path& folder, const HeldRig* rig) {
    const py::gil_scoped_release others_may_run;
    imports::write_folder(folder, held, rig == nullptr ? std::nullopt : rig->rig.camera);
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

RecordingPointer held(Recording recording, RecordingOrigin origin, std::filesystem::path folder) {
    imports::Assembled made;
    made.decimals = imports::decimals_without_log(recording);
    made.recording = std::move(recording);
    made.origin = std::move(origin);
    return std::make_shared<HeldRecording>(std::move(made), std::move(folder));
}

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
            "file. What NumPy makes an array of will do, as lists and a table of pandas; masked values are "
            "missing. `map` is the text of a map (format fidservo-map/1, docs/import.md) that says which "
            "array is what, in which unit. Raises InputError.")
        .def("write", &write, py::arg("folder"), py::arg("rig") = nullptr,
             "Writes a new recording folder, without images: every number as it is, so that reading gives "
             "the same recording. `rig`: whose camera saw the fiducials; its intrinsics are written, too. "
             "Raises InputError if the folder exists, RunFault if the disk fails.")
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
            "detections", [](HeldRecording& held) { return HeldDetections{held.shared_from_this()}; },
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
        "draft_map", [](const py::object& arrays) { return imports::draft_map(log_of(arrays)); },
        py::arg("arrays"),
        "A map to edit for Recording.from_arrays, under comments that list every array with its count, rate "
        "and range.");
}

}  // namespace fidservo::python
