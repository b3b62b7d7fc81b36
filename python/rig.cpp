// SPDX-License-Identifier: GPL-3.0-or-later
// Rig: what a rig file says.
#include "python/bindings.h"
#include "src/files/rig/rig_file.h"
#include "src/simulation/experiments.h"

#include <map>
#include <optional>
#include <utility>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace fidservo::python {

namespace py = pybind11;

namespace {

HeldRig load(const std::optional<std::filesystem::path>& file) {
    const std::filesystem::path path = file ? *file : reference_rig_file();
    return {load_rig(path), path};
}

std::map<std::string, std::map<std::string, double>> stated_effects(const HeldRig& held) {
    std::map<std::string, std::map<std::string, double>> effects;
    for (const StatedEffect& effect : held.rig.effects)
        for (const StatedEffect::Parameter& parameter : effect.parameters)
            effects[effect.name][parameter.name] = parameter.value;
    return effects;
}

std::vector<std::string> possible_experiments(const HeldRig& held) {
    std::vector<std::string> kinds;
    for (const std::string_view kind : experiment_kinds())
        if (missing_for(kind, held.rig).empty()) kinds.emplace_back(kind);
    return kinds;
}

std::optional<std::pair<int, int>> image_size(const HeldRig& held) {
    if (!held.rig.camera) return std::nullopt;
    return std::pair(held.rig.camera->geometry.width_px, held.rig.camera->geometry.height_px);
}

}  // namespace

void bind_rig(py::module_& module) {
    py::class_<HeldRig>(module, "Rig", "A rig as its file describes it. It never changes.")
        .def(py::init(&load), py::arg("file") = py::none(),
             "Reads a rig file; without one the reference rig's. Raises InputError that names file, key, "
             "value and what is allowed.")
        .def_readonly("file", &HeldRig::file, "The file that it was read from.")
        .def_property_readonly(
            "name", [](const HeldRig& held) { return held.rig.name; }, "Of the rig; recordings state it.")
        .def_property_readonly(
            "tick_s", [](const HeldRig& held) { return held.rig.tick_s; }, "Of the control loop, s.")
        .def_property_readonly(
            "travel_mm",
            [](const HeldRig& held) { return std::pair(held.rig.macro.low_mm, held.rig.macro.high_mm); },
            "Lower and upper end of the carriage's travel, mm.")
        .def_property_readonly(
            "encoder_resolution_mm", [](const HeldRig& held) { return held.rig.macro.encoder_resolution_mm; },
            "Of the carriage's encoder, mm per count.")
        .def_property_readonly(
            "has_micro", [](const HeldRig& held) { return held.rig.micro.has_value(); },
            "Whether it has a micro stage.")
        .def_property_readonly("image_size_px", &image_size,
                               "Width and height of its camera's images, px; None without a camera.")
        .def_property_readonly(
            "tag_side_mm",
            [](const HeldRig& held) {
                return held.rig.fiducials ? std::optional(held.rig.fiducials->side_mm) : std::nullopt;
            },
            "Of a fiducial's outline, mm; None without fiducials.")
        .def_property_readonly("effects", &stated_effects,
                               "The effects that its file states: the values of their parameters, in the "
                               "units of the catalogue, by name.")
        .def_property_readonly("experiments", &possible_experiments,
                               "The kinds of experiment that it can do.")
        .def("__repr__", [](const HeldRig& held) { return "Rig('" + held.file.string() + "')"; });
}

}  // namespace fidservo::python
