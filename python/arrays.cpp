// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays that a caller passes: any object that NumPy can convert, such as a list or a series of pandas.
#include "python/bindings.h"

namespace fidservo::python {

namespace py = pybind11;

std::string type_name(py::handle given) {
    return py::str(py::type::handle_of(given).attr("__name__"));
}

GivenArray array_of(const std::string& name, const py::object& given) {
    if (given.is_none()) throw py::type_error(name + ": is None; must be an array");
    const py::module_ numpy = py::module_::import("numpy");
    try {
        GivenArray array{.values = numpy.attr("asarray")(given), .mask = {}};
        const py::object masks = numpy.attr("ma");
        if (masks.attr("isMaskedArray")(given).cast<bool>()) {
            const py::object mask = masks.attr("getmaskarray")(given);
            if (mask.attr("any")().cast<bool>()) array.mask = py::array_t<bool>::ensure(mask);
        }
        return array;
    } catch (const py::error_already_set& error) {
        if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) throw;
        const std::string why = py::str(error.value());
        throw py::type_error(name + ": must be an array, not " + type_name(given) + ": " +
                             why.substr(0, why.find('\n')));
    }
}

}  // namespace fidservo::python
