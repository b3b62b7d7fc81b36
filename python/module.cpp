// SPDX-License-Identifier: GPL-3.0-or-later
// The compiled part of the Python package fidservo.
#include "core/input_error.h"
#include "gap/budget.h"
#include "python/bindings.h"
#include "src/files/recording/description.h"

#include <glog/logging.h>

namespace py = pybind11;

PYBIND11_MODULE(_fidservo, module) {
    FLAGS_minloglevel = google::GLOG_FATAL;  // as in the program: what Ceres says of its matrices
    module.doc() = "The compiled part of fidservo; import fidservo instead.";
    module.attr("__version__") = fidservo::this_program();
    py::register_exception<fidservo::InputError>(module, "InputError", PyExc_ValueError).doc() =
        "What was given is wrong: one line that names it and says what is allowed.";
    py::register_exception<fidservo::RunFault>(module, "RunFault", PyExc_RuntimeError).doc() =
        "A run that cannot go on: a disk that fails.";
    py::register_exception<fidservo::gap::BudgetEnded>(module, "BudgetEnded", PyExc_RuntimeError).doc() =
        "The time, or the effort, was over before anything was predicted.";
    fidservo::python::bind_rig(module);
    fidservo::python::bind_recording(module);
    fidservo::python::bind_simulation(module);
    fidservo::python::bind_tags(module);
    fidservo::python::bind_diagnosis(module);
}
