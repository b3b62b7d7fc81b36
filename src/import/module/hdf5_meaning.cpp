// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/hdf5_meaning.h"

#include "src/identify/column_units.h"
#include "src/import/log.h"
#include "src/import/module/hdf5_handle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::imports {
namespace {

struct StatedUnit {
    std::string by, unit;
};

/// By each of the attributes that name it, and by the dataset's name.
std::vector<StatedUnit> stated_units(hid_t dataset, const std::string& name) {
    std::vector<StatedUnit> stated;
    for (const char* attribute : {"unit", "units", "Unit", "Units", "UNIT", "UNITS"})
        if (const std::string unit = hdf5_attribute(dataset, attribute); !unit.empty()) {
            const Unit* known = find_unit(unit);
            stated.push_back({fmt::format("its attribute {}", attribute),
                              known == nullptr ? unit : std::string(known->name)});
        }
    if (const std::string unit = unit_of_name(name.substr(name.rfind('/') + 1)); !unit.empty())
        stated.push_back({"its name", unit});
    return stated;
}

void take_unit(hid_t dataset, const std::string& name, Hdf5Meaning& meaning) {
    const std::vector<StatedUnit> stated = stated_units(dataset, name);
    if (stated.empty()) return;
    const auto other =
        std::ranges::find_if(stated, [&](const StatedUnit& one) { return one.unit != stated.front().unit; });
    if (other == stated.end())
        meaning.unit = stated.front().unit;
    else
        meaning.said.push_back(fmt::format("{} states the unit {}, but {} states {}: the map has to state it",
                                           stated.front().by, stated.front().unit, other->by, other->unit));
}

/// The numbers of an attribute; none if it holds something else.
std::vector<double> numbers_of(hid_t dataset, const char* name) {
    constexpr hssize_t most = 1000;
    const Hdf5Handle attribute(H5Aopen(dataset, name, H5P_DEFAULT), H5Aclose);
    if (!attribute) return {};
    const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose),
        space(H5Aget_space(attribute.id()), H5Sclose);
    const H5T_class_t kind = H5Tget_class(type.id());
    const hssize_t count = H5Sget_simple_extent_npoints(space.id());
    if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || count < 1 || count > most) return {};
    std::vector<double> numbers(static_cast<std::size_t>(count));
    if (H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, numbers.data()) < 0) return {};
    return numbers;
}

void take_scaling(hid_t dataset, const char* attribute, double& factor, Hdf5Meaning& meaning) {
    if (H5Aexists(dataset, attribute) <= 0) return;
    const std::vector<double> numbers = numbers_of(dataset, attribute);
    if (numbers.size() != 1 || !std::isfinite(numbers.front())) {
        meaning.fault = fmt::format("its attribute {} is not one finite number", attribute);
        return;
    }
    if (numbers.front() == factor) return;
    factor = numbers.front();
    meaning.said.push_back(fmt::format("{} {} is applied", attribute, factor));
}

/// As a dataset of this type would hold it: 1e20 is another number in four bytes than in eight.
double as_stored(double number, hid_t type) {
    if (H5Tget_class(type) != H5T_FLOAT || H5Tget_size(type) > sizeof number) return number;
    if (H5Tconvert(H5T_NATIVE_DOUBLE, type, 1, &number, nullptr, H5P_DEFAULT) < 0 ||
        H5Tconvert(type, H5T_NATIVE_DOUBLE, 1, &number, nullptr, H5P_DEFAULT) < 0)
        return std::numeric_limits<double>::quiet_NaN();
    return number;
}

void take_missing(hid_t dataset, const char* attribute, Hdf5Meaning& meaning) {
    if (H5Aexists(dataset, attribute) <= 0) return;
    const std::vector<double> numbers = numbers_of(dataset, attribute);
    if (numbers.empty()) {
        meaning.fault = fmt::format("its attribute {} is no number", attribute);
        return;
    }
    const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
    for (const double number : numbers) meaning.missing.push_back(as_stored(number, type.id()));
}

}  // namespace

double Hdf5Meaning::value(double number) const {
    if (std::ranges::find(missing, number) != missing.end()) return std::numeric_limits<double>::quiet_NaN();
    return scale * number + offset;
}

Hdf5Meaning hdf5_meaning(hid_t dataset, const std::string& name) {
    Hdf5Meaning meaning;
    take_unit(dataset, name, meaning);
    take_scaling(dataset, "scale_factor", meaning.scale, meaning);
    take_scaling(dataset, "add_offset", meaning.offset, meaning);
    take_missing(dataset, "_FillValue", meaning);
    take_missing(dataset, "missing_value", meaning);
    return meaning;
}

}  // namespace fidservo::imports
