// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/mat73_variables.h"

#include "src/import/log.h"
#include "src/import/module/hdf5_handle.h"
#include "src/import/module/mat_objects.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace fidservo::imports {
namespace {

constexpr int most_groups_deep = 16;
constexpr std::size_t most_parts = 10 * most_signals;  ///< arrays, cells and fields of a file

Hdf5Handle open_mat73(const char* file) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    return {H5Fopen(file, H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
}

herr_t note_member(hid_t, const char* name, const H5L_info_t*, void* to) {
    static_cast<std::vector<std::string>*>(to)->emplace_back(name);
    return 0;
}

/// Nothing if libhdf5 cannot list them.
std::optional<std::vector<std::string>> members_of(hid_t group) {
    std::vector<std::string> names;
    if (H5Literate(group, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, note_member, &names) < 0)
        return std::nullopt;
    return names;
}

struct NumberClass {
    std::string_view matlab_class;
    matio_classes of;
    matio_types type;
};
constexpr std::array number_classes{
    NumberClass{"double", MAT_C_DOUBLE, MAT_T_DOUBLE}, NumberClass{"single", MAT_C_SINGLE, MAT_T_SINGLE},
    NumberClass{"logical", MAT_C_UINT8, MAT_T_UINT8},  NumberClass{"int8", MAT_C_INT8, MAT_T_INT8},
    NumberClass{"uint8", MAT_C_UINT8, MAT_T_UINT8},    NumberClass{"int16", MAT_C_INT16, MAT_T_INT16},
    NumberClass{"uint16", MAT_C_UINT16, MAT_T_UINT16}, NumberClass{"int32", MAT_C_INT32, MAT_T_INT32},
    NumberClass{"uint32", MAT_C_UINT32, MAT_T_UINT32}, NumberClass{"int64", MAT_C_INT64, MAT_T_INT64},
    NumberClass{"uint64", MAT_C_UINT64, MAT_T_UINT64}, NumberClass{"char", MAT_C_CHAR, MAT_T_UINT16}};

hid_t native_type(matio_types type) {
    switch (type) {
        case MAT_T_SINGLE:
            return H5T_NATIVE_FLOAT;
        case MAT_T_INT8:
            return H5T_NATIVE_INT8;
        case MAT_T_UINT8:
            return H5T_NATIVE_UINT8;
        case MAT_T_INT16:
            return H5T_NATIVE_INT16;
        case MAT_T_UINT16:
            return H5T_NATIVE_UINT16;
        case MAT_T_INT32:
            return H5T_NATIVE_INT32;
        case MAT_T_UINT32:
            return H5T_NATIVE_UINT32;
        case MAT_T_INT64:
            return H5T_NATIVE_INT64;
        case MAT_T_UINT64:
            return H5T_NATIVE_UINT64;
        default:
            return H5T_NATIVE_DOUBLE;
    }
}

/// By the attribute MATLAB_class; where there is none, by the type of HDF5. nullptr: no numbers.
const NumberClass* number_class_of(hid_t dataset, hid_t type) {
    std::string name = hdf5_attribute(dataset, "MATLAB_class");
    const H5T_class_t kind = H5Tget_class(type);
    if (name.empty() && (kind == H5T_FLOAT || kind == H5T_COMPOUND)) name = "double";
    if (name.empty() && kind == H5T_ENUM) name = "logical";
    if (name.empty() && kind == H5T_INTEGER)
        name = fmt::format("{}int{}", H5Tget_sign(type) == H5T_SGN_NONE ? "u" : "", 8 * H5Tget_size(type));
    const bool is_number =
        kind == H5T_FLOAT || kind == H5T_INTEGER || kind == H5T_ENUM || kind == H5T_COMPOUND;
    const auto known = std::ranges::find(number_classes, name, &NumberClass::matlab_class);
    return is_number && known != number_classes.end() ? &*known : nullptr;
}

/// In MATLAB's order, which is the reverse of HDF5's, and two at least.
std::vector<std::size_t> dims_of(hid_t space) {
    std::array<hsize_t, H5S_MAX_RANK> lengths{};
    const int rank = H5Sget_simple_extent_dims(space, lengths.data(), nullptr);
    std::vector<std::size_t> dims(lengths.begin(), lengths.begin() + std::max(0, rank));
    std::ranges::reverse(dims);
    while (dims.size() < 2) dims.push_back(1);
    return dims;
}

bool has_attribute(hid_t object, const char* name) {
    return H5Aexists(object, name) > 0;
}

class Mat73Reader {
  public:
    Variable variable_of(hid_t object, int depth) {
        if (object < 0 || depth > most_groups_deep || ++parts_ > most_parts)
            return variable_without_data(MAT_C_EMPTY);
        if (has_attribute(object, "MATLAB_object_decode") &&
            hdf5_attribute(object, "MATLAB_class") != "function_handle")
            return variable_without_data(MAT_C_OPAQUE);
        if (H5Iget_type(object) == H5I_GROUP) return group(object, depth);
        return H5Iget_type(object) == H5I_DATASET ? dataset(object, depth)
                                                  : variable_without_data(MAT_C_EMPTY);
    }
    bool has_too_many_parts() const { return parts_ > most_parts; }

  private:
    /// Whether so many more may be read; if so, they are counted.
    bool takes(std::uint64_t count) {
        if (count > most_values - values_) return false;
        values_ += count;
        return true;
    }

    Variable group(hid_t object, int depth) {
        if (has_attribute(object, "MATLAB_sparse")) return variable_without_data(MAT_C_SPARSE);
        if (hdf5_attribute(object, "MATLAB_class") == "function_handle")
            return variable_without_data(MAT_C_FUNCTION);
        const std::vector<std::string> names = members_of(object).value_or(std::vector<std::string>());
        if (names.empty()) return variable_without_data(MAT_C_EMPTY);
        if (names.size() > most_parts) {
            parts_ += names.size();
            return variable_without_data(MAT_C_EMPTY);
        }
        const auto references = element_references(object, names);
        std::vector<const char*> fields;
        fields.reserve(names.size() + 1);
        for (const std::string& name : names) fields.push_back(name.c_str());
        fields.push_back(nullptr);
        const std::array<std::size_t, 2> dims{1, references.empty() ? 1 : references.front().size()};
        Variable made(Mat_VarCreateStruct2(nullptr, dims.size(), dims.data(), fields.data()));
        if (made == nullptr) return variable_without_data(MAT_C_EMPTY);
        for (std::size_t field = 0; field < names.size(); ++field) {
            const Hdf5Handle member(H5Oopen(object, names[field].c_str(), H5P_DEFAULT), H5Oclose);
            for (std::size_t k = 0; k < std::min(dims[1], most_columns); ++k) {
                Variable value = references.empty() ? variable_of(member.id(), depth + 1)
                                 : k < references[field].size()
                                     ? referred(member.id(), references[field][k], depth)
                                     : variable_without_data(MAT_C_EMPTY);
                Mat_VarSetStructFieldByIndex(made.get(), field, k, value.release());
            }
        }
        return made;
    }

    /// An array of structures has references for each field, without a class; none if the group is one
    /// structure.
    std::vector<std::vector<hobj_ref_t>> element_references(hid_t object,
                                                            const std::vector<std::string>& names) {
        std::vector<std::vector<hobj_ref_t>> references;
        for (const std::string& name : names) {
            const Hdf5Handle member(H5Oopen(object, name.c_str(), H5P_DEFAULT), H5Oclose);
            if (!member || H5Iget_type(member.id()) != H5I_DATASET ||
                has_attribute(member.id(), "MATLAB_class"))
                return {};
            auto refers = references_of(member.id());
            if (!refers) return {};
            references.push_back(std::move(*refers));
        }
        return references;
    }

    /// Nothing if the dataset holds something else.
    std::optional<std::vector<hobj_ref_t>> references_of(hid_t object) {
        const Hdf5Handle type(H5Dget_type(object), H5Tclose), space(H5Dget_space(object), H5Sclose);
        const hssize_t count = space ? H5Sget_simple_extent_npoints(space.id()) : -1;
        if (!type || count < 0 || H5Tequal(type.id(), H5T_STD_REF_OBJ) <= 0) return std::nullopt;
        if (!takes(static_cast<std::uint64_t>(count))) return std::vector<hobj_ref_t>();
        std::vector<hobj_ref_t> references(static_cast<std::size_t>(count));
        if (count > 0 &&
            H5Dread(object, H5T_STD_REF_OBJ, H5S_ALL, H5S_ALL, H5P_DEFAULT, references.data()) < 0)
            return std::nullopt;
        return references;
    }

    Variable referred(hid_t near, const hobj_ref_t& reference, int depth) {
        const Hdf5Handle target(H5Rdereference2(near, H5P_DEFAULT, H5R_OBJECT, &reference), H5Oclose);
        return variable_of(target.id(), depth + 1);
    }

    Variable dataset(hid_t object, int depth) {
        if (const auto references = references_of(object)) {
            std::array<std::size_t, 2> dims{references->size(), 1};
            Variable made(
                Mat_VarCreate(nullptr, MAT_C_CELL, MAT_T_CELL, dims.size(), dims.data(), nullptr, 0));
            if (made == nullptr || references->empty()) return variable_without_data(MAT_C_EMPTY);
            if (made->data == nullptr) made->data = std::calloc(references->size(), sizeof(matvar_t*));
            for (std::size_t k = 0; k < std::min(references->size(), most_columns); ++k)
                Mat_VarSetCell(made.get(), static_cast<int>(k),
                               referred(object, (*references)[k], depth).release());
            return made;
        }
        return numbers(object);
    }

    Variable numbers(hid_t object) {
        const Hdf5Handle type(H5Dget_type(object), H5Tclose), space(H5Dget_space(object), H5Sclose);
        const NumberClass* known = type && space ? number_class_of(object, type.id()) : nullptr;
        if (known == nullptr) return variable_without_data(MAT_C_EMPTY);
        std::vector<std::size_t> dims = dims_of(space.id());
        // An empty array has its dimensions in place of its numbers.
        if (has_attribute(object, "MATLAB_empty") || H5Sget_simple_extent_type(space.id()) == H5S_NULL)
            dims = {0, 0};
        Variable made(Mat_VarCreate(nullptr, known->of, known->type, static_cast<int>(dims.size()),
                                    dims.data(), nullptr, 0));
        if (made == nullptr) return variable_without_data(MAT_C_EMPTY);
        made->isComplex = H5Tget_class(type.id()) == H5T_COMPOUND ? 1 : 0;
        const std::uint64_t count = made->nbytes / Mat_SizeOf(known->type);
        if (made->isComplex != 0 || count == 0 || !takes(count)) return made;
        made->data = std::malloc(made->nbytes);
        const bool is_read = made->data != nullptr && H5Dread(object, native_type(known->type), H5S_ALL,
                                                              H5S_ALL, H5P_DEFAULT, made->data) >= 0;
        if (!is_read) {
            std::free(made->data);
            made->data = nullptr;
        }
        return made;
    }

    std::uint64_t values_ = 0;
    std::size_t parts_ = 0;
};

}  // namespace

Variable variable_without_data(matio_classes of) {
    Variable made(Mat_VarCalloc());
    made->class_type = of;
    return made;
}

MatContents look_into_mat73(const char* file) {
    MatContents contents;
    const Hdf5Handle handle = open_mat73(file);
    const auto names = handle ? members_of(handle.id()) : std::nullopt;
    if (!names) return {.damage = "libhdf5 cannot open it: it is damaged or cut off"};
    for (const std::string& name : *names) {
        if (name.starts_with('#')) continue;
        const Hdf5Handle object(H5Oopen(handle.id(), name.c_str(), H5P_DEFAULT), H5Oclose);
        if (object && has_attribute(object.id(), "MATLAB_object_decode"))
            contents.faults[name] = advice_on_object(name, hdf5_attribute(object.id(), "MATLAB_class"));
    }
    return contents;
}

std::string read_mat73_variables(
    const char* file, const std::function<void(const std::string& name, const matvar_t& variable)>& take) {
    const Hdf5Handle handle = open_mat73(file);
    const auto names = handle ? members_of(handle.id()) : std::nullopt;
    if (!names) return "libhdf5 cannot list its variables: it is damaged";
    Mat73Reader reader;
    for (const std::string& name : *names) {
        if (name.starts_with('#')) continue;
        const Hdf5Handle object(H5Oopen(handle.id(), name.c_str(), H5P_DEFAULT), H5Oclose);
        take(name, *reader.variable_of(object.id(), 0));
        if (reader.has_too_many_parts())
            return fmt::format("more than {} arrays, cells and fields: are not read from one file",
                               most_parts);
    }
    return {};
}

}  // namespace fidservo::imports
