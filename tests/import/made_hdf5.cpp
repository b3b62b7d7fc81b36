// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/import/made_files.h"

#include <gtest/gtest.h>
#include <hdf5.h>

namespace fidservo::imports::testing {

void make_hdf5(const std::filesystem::path& file, const std::vector<MadeSignal>& signals) {
    const hid_t made = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    for (const MadeSignal& signal : signals) {
        const hsize_t count = signal.values.size();
        const hid_t space = H5Screate_simple(1, &count, nullptr);
        const hid_t set =
            H5Dcreate2(made, signal.name.c_str(), H5T_NATIVE_DOUBLE, space, links, H5P_DEFAULT, H5P_DEFAULT);
        EXPECT_GE(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, signal.values.data()), 0);
        if (!signal.unit.empty()) {
            const hid_t text = H5Tcopy(H5T_C_S1), scalar = H5Screate(H5S_SCALAR);
            H5Tset_size(text, H5T_VARIABLE);
            const hid_t attribute = H5Acreate2(set, "units", text, scalar, H5P_DEFAULT, H5P_DEFAULT);
            const char* unit = signal.unit.c_str();
            EXPECT_GE(H5Awrite(attribute, text, &unit), 0);
            H5Aclose(attribute);
            H5Sclose(scalar);
            H5Tclose(text);
        }
        H5Dclose(set);
        H5Sclose(space);
    }
    H5Pclose(links);
    H5Fclose(made);
}

void make_hdf5_table(const std::filesystem::path& file, const std::string& name,
                     const std::vector<MadeSignal>& columns) {
    const hid_t made = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = H5Tcreate(H5T_COMPOUND, columns.size() * sizeof(double));
    for (std::size_t k = 0; k < columns.size(); ++k)
        H5Tinsert(type, columns[k].name.c_str(), k * sizeof(double), H5T_NATIVE_DOUBLE);
    const hsize_t rows = columns.front().values.size();
    std::vector<double> bytes;
    for (std::size_t row = 0; row < rows; ++row)
        for (const MadeSignal& column : columns) bytes.push_back(column.values[row]);
    const hid_t space = H5Screate_simple(1, &rows, nullptr);
    const hid_t set = H5Dcreate2(made, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()), 0);
    H5Dclose(set);
    H5Sclose(space);
    H5Tclose(type);
    H5Fclose(made);
}

}  // namespace fidservo::imports::testing
