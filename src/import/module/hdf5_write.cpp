// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/hdf5_handle.h"
#include "src/import/module/hdf5_log.h"

#include <algorithm>

namespace fidservo::imports {
namespace {

bool write_text(hid_t parent, const char* name, const std::string& text, bool is_attribute) {
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
    H5Tset_size(type.id(), std::max<std::size_t>(1, text.size()));
    H5Tset_cset(type.id(), H5T_CSET_UTF8);
    H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
    if (is_attribute) {
        const Hdf5Handle attribute(H5Acreate2(parent, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT),
                                   H5Aclose);
        return attribute && H5Awrite(attribute.id(), type.id(), text.data()) >= 0;
    }
    const Hdf5Handle dataset(
        H5Dcreate2(parent, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    return dataset && H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) >= 0;
}

bool write_signal(hid_t file, const LoggedSignal& signal) {
    const hsize_t count = signal.values.size();
    const Hdf5Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose),
        links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links.id(), 1);
    const bool is_whole = !signal.whole.empty();
    const hid_t type = is_whole ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE;
    const Hdf5Handle dataset(
        H5Dcreate2(file, signal.name.c_str(), type, space.id(), links.id(), H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    const void* data = is_whole ? static_cast<const void*>(signal.whole.data()) : signal.values.data();
    return dataset && H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0 &&
           (signal.unit.empty() || write_text(dataset.id(), "unit", signal.unit, true));
}

}  // namespace

std::string write_hdf5_file(const char* file, const Log& log) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const Hdf5Handle handle(H5Fcreate(file, H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    if (!handle) return "libhdf5 cannot make it";
    for (const LoggedSignal& signal : log.signals)
        if (!write_signal(handle.id(), signal)) return "libhdf5 could not write " + signal.name;
    for (const auto& [name, text] : log.texts)
        if (!write_text(handle.id(), name.c_str(), text, false)) return "libhdf5 could not write " + name;
    return H5Fflush(handle.id(), H5F_SCOPE_LOCAL) >= 0 ? std::string() : "libhdf5 could not write all of it";
}

}  // namespace fidservo::imports
