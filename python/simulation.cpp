// SPDX-License-Identifier: GPL-3.0-or-later
// simulate: recordings of the simulated rig.
#include "core/input_error.h"
#include "python/bindings.h"
#include "src/files/recording/row_format.h"
#include "src/simulation/experiment_file.h"
#include "src/simulation/planned_experiments.h"
#include "src/simulation/simulate.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace fidservo::python {

namespace py = pybind11;

namespace {

using Texts = std::vector<std::string>;
using OptionalPath = std::optional<std::filesystem::path>;

/// With the numbers that the program's folder of it has.
RecordingPointer as_recorded(Recording recording) {
    round_as_written(recording);
    return held(std::move(recording), {}, {});
}

/// As planned_experiment demands it, in Python's words: a campaign has a function of its own there.
void demand_experiment(const std::string& asked) {
    if (is_experiment_file(asked) || std::ranges::count(experiment_kinds(), asked) > 0) return;
    throw InputError(fmt::format(
        "{}: unknown experiment; allowed: {}, the path of a FILE.yaml; simulate_campaign makes all", asked,
        fmt::join(experiment_kinds(), ", ")));
}

/// Calls `on_frame` with a frame's time and its image, which is a copy. Python may raise there, Ctrl-C too.
FilmCamera::Keep calling(const py::function& on_frame) {
    return [&on_frame](TimeNs stamp_ns, const cv::Mat& image) {
        const py::gil_scoped_acquire in_python;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        const cv::Mat whole = image.isContinuous() ? image : image.clone();
        on_frame(stamp_ns, py::array_t<std::uint8_t>({whole.rows, whole.cols}, whole.data));
    };
}

RecordingPointer simulate_one(const HeldRig& rig, const std::string& experiment, const Texts& effects,
                              const OptionalPath& effects_file, std::uint64_t seed,
                              const std::optional<py::function>& on_frame) {
    if (on_frame && !(rig.rig.camera && rig.rig.fiducials))
        throw py::value_error("on_frame: the rig " + rig.rig.name +
                              " lacks a camera, or fiducials for it to see");
    const FilmCamera::Keep keep = on_frame ? calling(*on_frame) : FilmCamera::Keep();
    const py::gil_scoped_release others_may_run;
    demand_experiment(experiment);
    const auto [name, planned] = planned_experiment(experiment, rig.rig, seed);
    const auto settings = effects_of(effects, effects_file.value_or(""));
    return as_recorded(simulate(rig.rig, settings, planned, name, seed, keep));
}

std::vector<RecordingPointer> simulate_all(const HeldRig& rig, const Texts& effects,
                                           const OptionalPath& effects_file, std::uint64_t seed) {
    const py::gil_scoped_release others_may_run;
    const auto settings = effects_of(effects, effects_file.value_or(""));
    std::vector<RecordingPointer> all;
    for (const auto& [name, planned] : planned_campaign(rig.rig, seed)) {
        all.push_back(as_recorded(simulate(rig.rig, settings, planned, name, seed)));
        const py::gil_scoped_acquire in_python;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
    return all;
}

}  // namespace

void bind_simulation(py::module_& module) {
    module.def(
        "simulate", &simulate_one, py::arg("rig"), py::arg("experiment"), py::kw_only(),
        py::arg("effects") = Texts(), py::arg("effects_file") = py::none(), py::arg("seed") = 1,
        py::arg("on_frame") = py::none(),
        "Records an experiment on the simulated rig, as `fidservo simulate` does: the same seed gives the "
        "same numbers.\n\n"
        "experiment: one of rig.experiments, or the path of an experiment file (docs/formats.md).\n"
        "effects: what the rig has and its file does not state, 'NAME' or 'NAME:PARAMETER=VALUE,...'.\n"
        "effects_file: effects as formulas (docs/effects.md); where `effects` names none of them, all act at "
        "their typical values.\n"
        "on_frame: called with the time, ns, and the image, uint8, of each frame that the camera takes; "
        "fiducials are then found in the images.\n\n"
        "Raises InputError.");
    module.def(
        "simulate_campaign", &simulate_all, py::arg("rig"), py::kw_only(), py::arg("effects") = Texts(),
        py::arg("effects_file") = py::none(), py::arg("seed") = 1,
        "Records two of each experiment that the rig can do, on the simulated rig: what a diagnosis is "
        "best made from. Arguments as of simulate.");
}

}  // namespace fidservo::python
