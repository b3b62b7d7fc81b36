// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What the parts of the module share. There is no logic here: each function calls the one that the program's
// command calls, too.
#include "core/recording.h"
#include "core/rig.h"
#include "src/import/assemble.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace fidservo::python {

/// A rig and the file that it was read from.
struct HeldRig {
    Rig rig;
    std::filesystem::path file;
};

/// A recording that arrays look into, and what a folder of it states; it never changes.
struct HeldRecording : imports::Assembled, std::enable_shared_from_this<HeldRecording> {
    explicit HeldRecording(imports::Assembled made, std::filesystem::path folder_ = {})
        : imports::Assembled(std::move(made)), folder(std::move(folder_)) {}

    std::filesystem::path folder;  ///< where its frames are; empty: it has none
};
using RecordingPointer = std::shared_ptr<HeldRecording>;

/// One that was not imported.
RecordingPointer held(Recording recording, RecordingOrigin origin, std::filesystem::path folder);

/// An array as it was given.
struct GivenArray {
    pybind11::array values;
    std::optional<pybind11::array_t<bool>> mask;  ///< true where a value is missing; empty: nowhere
};

/// Converts an object to an array. Throws TypeError "NAME: ...", one line, if NumPy cannot.
GivenArray array_of(const std::string& name, const pybind11::object& given);
/// The name of an object's type.
std::string type_name(pybind11::handle given);

/// Values that `owner` keeps, as a read-only array without a copy.
template <class Value>
pybind11::array view(const Value* first, std::vector<pybind11::ssize_t> shape,
                     std::vector<pybind11::ssize_t> strides, pybind11::handle owner) {
    pybind11::array array(pybind11::dtype::of<Value>(), std::move(shape), std::move(strides), first, owner);
    array.attr("setflags")(pybind11::arg("write") = false);
    return array;
}

void bind_rig(pybind11::module_& module);
void bind_recording(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);
void bind_tags(pybind11::module_& module);
void bind_diagnosis(pybind11::module_& module);

}  // namespace fidservo::python
