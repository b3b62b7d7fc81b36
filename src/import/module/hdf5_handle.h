// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Identifiers of libhdf5 that are closed with their scope; attributes as texts.
#include <string>

#include <hdf5.h>

namespace fidservo::imports {

class Hdf5Handle {
  public:
    Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~Hdf5Handle() {
        if (id_ >= 0) close_(id_);
    }
    Hdf5Handle(const Hdf5Handle&) = delete;
    Hdf5Handle& operator=(const Hdf5Handle&) = delete;
    hid_t id() const { return id_; }
    explicit operator bool() const { return id_ >= 0; }

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

/// The string in a dataset or an attribute with a single element; empty if it is not of this kind.
std::string hdf5_text(hid_t type, hid_t space, const auto& read) {
    constexpr std::size_t most_bytes = std::size_t{1} << 24U;
    if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1) return {};
    if (H5Tis_variable_str(type) > 0) {
        char* text = nullptr;
        const Hdf5Handle memory(H5Tcopy(H5T_C_S1), H5Tclose);
        H5Tset_size(memory.id(), H5T_VARIABLE);
        H5Tset_cset(memory.id(), H5Tget_cset(type));
        if (read(memory.id(), static_cast<void*>(&text)) < 0 || text == nullptr) return {};
        std::string copy(text);
        H5free_memory(text);
        return copy;
    }
    const std::size_t size = H5Tget_size(type);
    if (size == 0 || size > most_bytes) return {};
    std::string text(size, '\0');
    if (read(type, static_cast<void*>(text.data())) < 0) return {};
    return text.substr(0, text.find('\0'));
}

/// The value of a string attribute without leading and trailing blanks; empty if it does not exist or is no
/// string.
inline std::string hdf5_attribute(hid_t object, const char* name) {
    if (H5Aexists(object, name) <= 0) return {};
    const Hdf5Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
    if (!attribute) return {};
    const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose),
        space(H5Aget_space(attribute.id()), H5Sclose);
    if (!type || !space) return {};
    const std::string text = hdf5_text(
        type.id(), space.id(), [&](hid_t memory, void* to) { return H5Aread(attribute.id(), memory, to); });
    constexpr const char* blanks = " \t\r\n";
    const auto first = text.find_first_not_of(blanks);
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace fidservo::imports
