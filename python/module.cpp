// SPDX-License-Identifier: GPL-3.0-or-later
// The compiled part of the Python package fidservo.
#include "core/input_error.h"
#include "gap/budget.h"
#include "python/bindings.h"
#include "src/files/recording/description.h"

#include <string>

#include <glog/logging.h>

namespace fidservo::python {

namespace py = pybind11;

namespace {

void bind_errors(py::module_& module) {
    py::register_exception<InputError>(module, "InputError", PyExc_ValueError).doc() =
        "What was given is wrong: one line that names it and says what is allowed.";
    py::register_exception<RunFault>(module, "RunFault", PyExc_RuntimeError).doc() =
        "A run that cannot go on: a disk that fails.";
    py::register_exception<gap::BudgetEnded>(module, "BudgetEnded", PyExc_RuntimeError).doc() =
        "The time, or the effort, was over before anything was predicted.";
}

/// Sets the module name of all classes to that of the package, since its users never import the compiled
/// module.
void name_after_package(py::module_& module) {
    for (const auto item : py::dict(module.attr("__dict__")))
        if (py::isinstance<py::type>(item.second)) item.second.attr("__module__") = "fidservo";
}

}  // namespace

}  // namespace fidservo::python

PYBIND11_MODULE(_fidservo, module) {
    using namespace fidservo::python;
    FLAGS_minloglevel = google::GLOG_FATAL;  // as in the program: what Ceres says of its matrices
    module.doc() = "The compiled part of fidservo; import fidservo instead.";
    module.attr("__version__") = fidservo::this_program();
    bind_errors(module);
    bind_rig(module);
    bind_recording(module);
    bind_simulation(module);
    bind_tags(module);
    bind_diagnosis(module);
    name_after_package(module);
}
