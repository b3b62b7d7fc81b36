// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/hdf5_dataset.h"

#include "src/import/module/hdf5_handle.h"
#include "src/import/module/hdf5_meaning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo::imports {
namespace {

constexpr std::size_t most_nested = 8;

/// A dataset, or a member of its compound type, at any depth.
struct Part {
    hid_t dataset;
    std::string name;                 ///< of the signal
    std::vector<hsize_t> dims{};      ///< of the dataset
    std::vector<std::string> path{};  ///< names of members, from the outside
    Hdf5Meaning meaning{};
};

/// Samples in rows; the columns of rows side by side are C's.
struct Shape {
    std::size_t rows = 0, columns = 1, row_step = 1, column_step = 1;
};

bool is_bits(hid_t type) {
    return H5Tget_class(type) == H5T_BITFIELD && H5Tget_size(type) == 1;
}

/// Truth values are enumerations for h5py, and bits for PyTables.
bool is_number(hid_t type) {
    const H5T_class_t kind = H5Tget_class(type);
    return kind == H5T_INTEGER || kind == H5T_FLOAT || kind == H5T_ENUM || is_bits(type);
}

/// Integers of eight bytes lose digits in a double.
bool is_wide_integer(hid_t type) {
    return H5Tget_class(type) == H5T_INTEGER && H5Tget_size(type) == sizeof(std::int64_t);
}

std::string what_it_holds(hid_t type) {
    switch (H5Tget_class(type)) {
        case H5T_STRING:
            return "holds texts";
        case H5T_VLEN:
            return "holds lists of lengths of their own";
        case H5T_REFERENCE:
            return "holds references to other parts of the file";
        case H5T_COMPOUND:
            return fmt::format("holds compounds in arrays, or in more than {} compounds", most_nested);
        case H5T_ARRAY:
            return "holds arrays of arrays";
        default:
            return "holds no numbers";
    }
}

/// Of a dataset's elements: samples run along the longer of two dimensions; but where the elements are
/// arrays, along the dataset's own. More than two dimensions have to be of length 1 but for two.
std::optional<Shape> shape_of(std::vector<hsize_t> dims, std::vector<hsize_t> inner) {
    const auto without_ones = [](std::vector<hsize_t>& lengths) { std::erase(lengths, hsize_t{1}); };
    if (std::ranges::count(dims, 0U) + std::ranges::count(inner, 0U) > 0) return Shape{};
    if (!inner.empty()) {
        without_ones(dims);
        without_ones(inner);
        if (dims.size() > 1 || inner.size() > 1) return std::nullopt;
        const std::size_t columns = inner.empty() ? 1 : inner.front();
        return Shape{dims.empty() ? 1 : dims.front(), columns, columns, 1};
    }
    if (dims.size() > 2) without_ones(dims);
    if (dims.size() > 2) return std::nullopt;
    if (dims.empty()) return Shape{1, 1, 1, 1};
    if (dims.size() == 1) return Shape{dims[0], 1, 1, 1};
    if (dims[0] >= dims[1]) return Shape{dims[0], dims[1], dims[1], 1};
    return Shape{dims[1], dims[0], 1, dims[1]};
}

/// The type in memory of a part's elements alone.
Hdf5Handle memory_type(hid_t number, std::span<const hsize_t> inner, std::span<const std::string> path) {
    hid_t type = inner.empty() ? H5Tcopy(number)
                               : H5Tarray_create2(number, static_cast<unsigned>(inner.size()), inner.data());
    for (auto member = path.rbegin(); member != path.rend(); ++member) {
        const hid_t outer = H5Tcreate(H5T_COMPOUND, H5Tget_size(type));
        H5Tinsert(outer, member->c_str(), 0, type);
        H5Tclose(type);
        type = outer;
    }
    return {type, H5Tclose};
}

template <class Number>
std::optional<std::vector<Number>> numbers_of_part(const Part& part, std::span<const hsize_t> inner,
                                                   std::size_t count, hid_t number) {
    std::vector<Number> numbers(count);
    const Hdf5Handle memory = memory_type(number, inner, part.path);
    if (count > 0 && H5Dread(part.dataset, memory.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) < 0)
        return std::nullopt;
    return numbers;
}

std::optional<std::vector<double>> doubles_of_part(const Part& part, std::span<const hsize_t> inner,
                                                   std::size_t count, hid_t element) {
    if (!is_bits(element)) return numbers_of_part<double>(part, inner, count, H5T_NATIVE_DOUBLE);
    const auto bits = numbers_of_part<std::uint8_t>(part, inner, count, H5T_NATIVE_B8);
    if (!bits) return std::nullopt;
    return std::vector<double>(bits->begin(), bits->end());
}

/// A sentence on what the attributes made of the numbers.
void note_meaning(Hdf5Reading& reading, const Part& part, std::size_t missing) {
    std::vector<std::string> said = part.meaning.said;
    if (missing > 0)
        said.push_back(
            fmt::format("{} samples are missing: their number is {}, by _FillValue or missing_value", missing,
                        fmt::join(part.meaning.missing, " or ")));
    if (!said.empty()) reading.log.notes.push_back(fmt::format("{}: {}", part.name, fmt::join(said, "; ")));
}

void read_numbers(Hdf5Reading& reading, const Part& part, hid_t element, std::span<const hsize_t> inner,
                  const Shape& shape) {
    const std::size_t count = shape.rows * shape.columns;
    auto values = doubles_of_part(part, inner, count, element);
    std::optional<std::vector<std::int64_t>> whole(std::in_place);
    constexpr double first_too_large = 0x1p63;
    if (is_wide_integer(element) && values &&
        std::ranges::all_of(*values, [](double value) { return value < first_too_large; }))
        whole = numbers_of_part<std::int64_t>(part, inner, count, H5T_NATIVE_INT64);
    if (!values || !whole) {
        reading.pass_over(part.name, "libhdf5 cannot read its data");
        return;
    }
    std::size_t missing = 0;
    if (!part.meaning.is_identity()) {
        for (double& value : *values) {
            const bool is_number = !std::isnan(value);
            value = part.meaning.value(value);
            if (is_number && std::isnan(value)) ++missing;
        }
        if (missing > 0 || part.meaning.scale != 1.0 || part.meaning.offset != 0.0) whole->clear();
    }
    note_meaning(reading, part, missing);
    add_columns(reading.log, {.name = part.name, .unit = part.meaning.unit}, shape.rows, shape.columns,
                [&](LoggedSignal& signal, std::size_t row, std::size_t column) {
                    const std::size_t at = row * shape.row_step + column * shape.column_step;
                    signal.values.push_back((*values)[at]);
                    if (!whole->empty()) signal.whole.push_back((*whole)[at]);
                });
}

/// A part whose elements are numbers or arrays of them.
void read_elements(Hdf5Reading& reading, const Part& part, hid_t type) {
    std::array<hsize_t, H5S_MAX_RANK> lengths{};
    const bool is_array = H5Tget_class(type) == H5T_ARRAY;
    const int rank = is_array ? H5Tget_array_dims2(type, lengths.data()) : 0;
    const std::vector<hsize_t> inner(lengths.begin(), lengths.begin() + std::max(0, rank));
    const Hdf5Handle element(is_array ? H5Tget_super(type) : H5Tcopy(type), H5Tclose);
    if (!part.meaning.fault.empty()) return reading.pass_over(part.name, part.meaning.fault);
    if (!element || !is_number(element.id()))
        return reading.pass_over(part.name, what_it_holds(element ? element.id() : type));
    const auto shape = shape_of(part.dims, inner);
    if (!shape)
        return reading.pass_over(
            part.name, fmt::format("has {} dimensions; at most 2 are read", part.dims.size() + inner.size()));
    if (shape->columns > most_columns)
        return reading.pass_over(
            part.name, fmt::format("has {} columns; at most {} are read", shape->columns, most_columns));
    if (shape->rows > (most_values - reading.values) / shape->columns)
        return reading.pass_over(part.name, too_many_numbers(shape->rows * shape->columns));
    reading.values += shape->rows * shape->columns;
    read_numbers(reading, part, element.id(), inner, *shape);
}

void read_compound(Hdf5Reading& reading, const Part& part, hid_t type) {
    const int members = H5Tget_nmembers(type);
    for (int k = 0; k < members && reading.usable() < most_signals; ++k) {
        const auto index = static_cast<unsigned>(k);
        const Hdf5Handle member(H5Tget_member_type(type, index), H5Tclose);
        char* member_name = H5Tget_member_name(type, index);
        const std::string plain = member_name == nullptr ? fmt::format("{}", k + 1) : member_name;
        H5free_memory(member_name);
        Part inner{part.dataset, fmt::format("{}.{}", part.name, plain), part.dims, part.path};
        inner.path.push_back(plain);
        inner.meaning.unit = unit_of_name(plain);
        if (member && H5Tget_class(member.id()) == H5T_COMPOUND && inner.path.size() < most_nested)
            read_compound(reading, inner, member.id());
        else if (member)
            read_elements(reading, inner, member.id());
        else
            reading.pass_over(inner.name, "libhdf5 cannot tell its type");
    }
}

}  // namespace

void read_hdf5_dataset(Hdf5Reading& reading, hid_t dataset, const std::string& name) {
    const Hdf5Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
    if (!type || !space) return reading.pass_over(name, "libhdf5 cannot tell its type");
    if (const std::string text = hdf5_text(type.id(), space.id(),
                                           [&](hid_t memory, void* to) {
                                               return H5Dread(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                                              to);
                                           });
        !text.empty()) {
        reading.log.texts[name.substr(1)] = text;
        return;
    }
    std::array<hsize_t, H5S_MAX_RANK> dims{};
    const int rank = H5Sget_simple_extent_ndims(space.id());
    if (rank < 0 || H5Sget_simple_extent_type(space.id()) == H5S_NULL)
        return reading.pass_over(name, "holds nothing");
    H5Sget_simple_extent_dims(space.id(), dims.data(), nullptr);
    Part part{dataset, name, std::vector<hsize_t>(dims.begin(), dims.begin() + rank)};
    if (H5Tget_class(type.id()) == H5T_COMPOUND) return read_compound(reading, part, type.id());
    part.meaning = hdf5_meaning(dataset, name);
    read_elements(reading, part, type.id());
}

}  // namespace fidservo::imports
