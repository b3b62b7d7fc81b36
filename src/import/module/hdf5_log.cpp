// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/hdf5_log.h"

#include "src/identify/column_units.h"
#include "src/import/module/hdf5_handle.h"
#include "src/import/module/mat_objects.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>

#include <fmt/format.h>

namespace fidservo::imports {
namespace {

struct Reading {
    Log log;
    std::string fault;
    std::uint64_t values = 0;
    std::size_t passed_over = 0;
};

bool is_number(hid_t type) {
    const H5T_class_t kind = H5Tget_class(type);
    return kind == H5T_INTEGER || kind == H5T_FLOAT;
}

/// Integers of eight bytes lose digits in a double.
bool is_wide_integer(hid_t type) {
    return H5Tget_class(type) == H5T_INTEGER && H5Tget_size(type) == sizeof(std::int64_t);
}

std::string unit_of(hid_t dataset, const std::string& name) {
    for (const char* attribute : {"unit", "units", "Unit", "Units"})
        if (std::string unit = hdf5_attribute(dataset, attribute); !unit.empty()) {
            const Unit* known = find_unit(unit);
            return known == nullptr ? unit : std::string(known->name);
        }
    return title_parts(name.substr(name.rfind('/') + 1)).unit;
}

/// Rows and columns: samples run along the longer dimension, and the columns of rows side by side are C's.
struct Shape {
    std::size_t rows = 0, columns = 1, row_step = 1, column_step = 1;
};

std::optional<Shape> shape_of(std::span<const hsize_t> dims) {
    if (dims.empty()) return Shape{1, 1, 1, 1};
    if (dims.size() == 1) return Shape{dims[0], 1, 1, 1};
    if (dims.size() != 2) return std::nullopt;
    if (dims[0] >= dims[1]) return Shape{dims[0], dims[1], dims[1], 1};
    return Shape{dims[1], dims[0], 1, dims[1]};
}

void read_numbers(Reading& reading, hid_t dataset, hid_t file_type, hid_t memory_of_double,
                  hid_t memory_of_whole, const LoggedSignal& like, const Shape& shape) {
    const std::size_t count = shape.rows * shape.columns;
    std::vector<double> values(count);
    std::vector<std::int64_t> whole(is_wide_integer(file_type) ? count : 0);
    const bool is_read =
        count == 0 ||
        (H5Dread(dataset, memory_of_double, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0 &&
         (whole.empty() ||
          H5Dread(dataset, memory_of_whole, H5S_ALL, H5S_ALL, H5P_DEFAULT, whole.data()) >= 0));
    if (!is_read) {
        LoggedSignal signal = like;
        signal.fault = "libhdf5 cannot read its data";
        reading.log.signals.push_back(std::move(signal));
        return;
    }
    add_columns(reading.log, like, shape.rows, shape.columns,
                [&](LoggedSignal& signal, std::size_t row, std::size_t column) {
                    const std::size_t at = row * shape.row_step + column * shape.column_step;
                    signal.values.push_back(values[at]);
                    if (!whole.empty()) signal.whole.push_back(whole[at]);
                });
}

void read_compound(Reading& reading, hid_t dataset, hid_t type, const std::string& name, const Shape& shape) {
    const int members = H5Tget_nmembers(type);
    for (int k = 0; k < members; ++k) {
        const auto index = static_cast<unsigned>(k);
        const Hdf5Handle member(H5Tget_member_type(type, index), H5Tclose);
        char* member_name = H5Tget_member_name(type, index);
        const std::string plain = member_name == nullptr ? fmt::format("{}", k + 1) : member_name;
        H5free_memory(member_name);
        if (!member || !is_number(member.id())) continue;
        const auto only = [&](hid_t native) {
            const hid_t memory = H5Tcreate(H5T_COMPOUND, H5Tget_size(native));
            H5Tinsert(memory, plain.c_str(), 0, native);
            return memory;
        };
        const Hdf5Handle as_double(only(H5T_NATIVE_DOUBLE), H5Tclose),
            as_whole(only(H5T_NATIVE_INT64), H5Tclose);
        read_numbers(reading, dataset, member.id(), as_double.id(), as_whole.id(),
                     {.name = fmt::format("{}.{}", name, plain), .unit = title_parts(plain).unit}, shape);
    }
}

void read_dataset(Reading& reading, hid_t dataset, const std::string& name) {
    const Hdf5Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
    if (!type || !space) return;
    if (const std::string text = hdf5_text(type.id(), space.id(),
                                           [&](hid_t memory, void* to) {
                                               return H5Dread(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                                              to);
                                           });
        !text.empty()) {
        reading.log.texts[name.substr(1)] = text;
        return;
    }
    const bool is_compound = H5Tget_class(type.id()) == H5T_COMPOUND;
    std::array<hsize_t, H5S_MAX_RANK> dims{};
    const int rank = H5Sget_simple_extent_ndims(space.id());
    const bool is_simple = rank >= 0 && H5Sget_simple_extent_type(space.id()) != H5S_NULL;
    if (is_simple) H5Sget_simple_extent_dims(space.id(), dims.data(), nullptr);
    const auto shape =
        is_simple ? shape_of(std::span(dims).first(static_cast<std::size_t>(rank))) : std::nullopt;
    if (!shape || (!is_compound && !is_number(type.id())) || shape->columns > most_columns) {
        ++reading.passed_over;
        return;
    }
    const std::uint64_t per_row =
        shape->columns *
        static_cast<std::uint64_t>(is_compound ? std::max(1, H5Tget_nmembers(type.id())) : 1);
    if (shape->rows > (most_values - reading.values) / per_row) {
        reading.fault =
            fmt::format("{}: more than {} numbers: are not read from one file", name, most_values);
        return;
    }
    reading.values += shape->rows * per_row;
    if (is_compound)
        read_compound(reading, dataset, type.id(), name, *shape);
    else
        read_numbers(reading, dataset, type.id(), H5T_NATIVE_DOUBLE, H5T_NATIVE_INT64,
                     {.name = name, .unit = unit_of(dataset, name)}, *shape);
}

herr_t visit(hid_t file, const char* path, const H5O_info_t* info, void* to) {
    auto& reading = *static_cast<Reading*>(to);
    if (info->type != H5O_TYPE_DATASET) return 0;
    const std::string name = "/" + std::string(path);
    if (reading.log.signals.size() >= most_signals) {
        reading.fault = fmt::format("more than {} datasets: are not read from one file", most_signals);
        return 1;
    }
    const Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!dataset)
        reading.log.signals.push_back({.name = name, .fault = "libhdf5 cannot open it"});
    else
        read_dataset(reading, dataset.id(), name);
    return reading.fault.empty() ? 0 : 1;
}

Hdf5Handle open_to_read(const char* file) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    return {H5Fopen(file, H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
}

herr_t note_matlab_object(hid_t group, const char* name, const H5L_info_t*, void* to) {
    auto& contents = *static_cast<MatContents*>(to);
    if (name[0] == '#') return 0;
    const Hdf5Handle object(H5Oopen(group, name, H5P_DEFAULT), H5Oclose);
    if (!object || H5Aexists(object.id(), "MATLAB_object_decode") <= 0) return 0;
    contents.objects[name] = hdf5_attribute(object.id(), "MATLAB_class");
    return 0;
}

}  // namespace

LogOrFault read_hdf5_file(const char* file) {
    const Hdf5Handle handle = open_to_read(file);
    if (!handle)
        return tl::make_unexpected(
            std::string("libhdf5 cannot open it: it is damaged, cut off or still being written"));
    Reading reading;
    const herr_t visited =
        H5Ovisit2(handle.id(), H5_INDEX_NAME, H5_ITER_NATIVE, visit, &reading, H5O_INFO_BASIC);
    if (!reading.fault.empty()) return tl::make_unexpected(reading.fault);
    if (visited < 0) return tl::make_unexpected(std::string("libhdf5 cannot list its groups: it is damaged"));
    if (reading.passed_over > 0)
        reading.log.notes.push_back(
            fmt::format("{} datasets passed over: they are not columns of numbers", reading.passed_over));
    if (reading.log.signals.empty() && reading.log.texts.empty())
        return tl::make_unexpected(std::string("holds no dataset of numbers in one or two dimensions"));
    return std::move(reading.log);
}

MatContents look_into_mat73(const char* file) {
    MatContents contents;
    const Hdf5Handle handle = open_to_read(file);
    if (!handle) {
        contents.damage = "libhdf5 cannot open it: it is damaged or cut off";
        return contents;
    }
    H5Literate(handle.id(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, note_matlab_object, &contents);
    return contents;
}

}  // namespace fidservo::imports
