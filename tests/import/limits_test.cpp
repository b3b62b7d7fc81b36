// SPDX-License-Identifier: GPL-3.0-or-later
// Files of MATLAB and HDF5 with more, larger and deeper things than usual: read, or passed over by name.
#include "src/import/read_log.h"
#include "tests/import/made_files.h"
#include "tests/src/temporary_folder.h"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <matio.h>

namespace fidservo::imports {
namespace {

using fidservo::testing::TemporaryFolder;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct CloseMadeMat {
    void operator()(mat_t* mat) const { Mat_Close(mat); }
};
using MadeMat = std::unique_ptr<mat_t, CloseMadeMat>;

MadeMat made_mat(const std::filesystem::path& file, mat_ft format) {
    return MadeMat(Mat_CreateVer(file.c_str(), nullptr, format));
}

/// Writes a variable, which it deletes.
void write_variable(const MadeMat& mat, matvar_t* variable) {
    EXPECT_EQ(Mat_VarWrite(mat.get(), variable, MAT_COMPRESSION_NONE), 0);
    Mat_VarFree(variable);
}

matvar_t* number_variable(const char* name, double value) {
    std::array<std::size_t, 2> dims{1, 1};
    return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims.data(), &value, 0);
}

/// A row of cells with a number each.
matvar_t* cells_variable(const char* name, std::size_t count) {
    std::array<std::size_t, 2> dims{1, count};
    std::vector<matvar_t*> cells(count);
    for (std::size_t k = 0; k < count; ++k) cells[k] = number_variable(nullptr, static_cast<double>(k));
    return Mat_VarCreate(name, MAT_C_CELL, MAT_T_CELL, 2, dims.data(), cells.data(), 0);
}

const LoggedSignal& signal_of(const Log& log, const std::string& name) {
    static const LoggedSignal none{};
    const LoggedSignal* signal = log.find(name);
    EXPECT_NE(signal, nullptr) << name;
    return signal == nullptr ? none : *signal;
}

TEST(NamesInHdf5, WithAUnitInBrackets_AreNameAndUnit) {
    const TemporaryFolder folder;
    testing::make_hdf5(folder / "log.h5", {{"/log/position [mm]", {1.0, 2.0}},
                                           {"/log/current (A)", {1.0, 2.0}},
                                           {"/log/x_mm", {1.0, 2.0}},
                                           {"/log/joint[2]", {1.0, 2.0}},
                                           {"/log/both [V]", {1.0, 2.0}},
                                           {"/log/both [mm]", {1.0, 2.0}},
                                           {"/log/force [um]", {1.0, 2.0}, "mm"}});
    const Log log = read_log(folder / "log.h5", testing::no_table_options);
    EXPECT_EQ(signal_of(log, "/log/position").unit, "mm");
    EXPECT_EQ(signal_of(log, "/log/current").unit, "A");
    EXPECT_EQ(signal_of(log, "/log/x_mm").unit, "mm");
    EXPECT_EQ(signal_of(log, "/log/joint[2]").unit, "") << "2 is an index";
    EXPECT_EQ(signal_of(log, "/log/both [V]").unit, "V") << "names stay different";
    EXPECT_EQ(signal_of(log, "/log/both [mm]").unit, "mm");
    EXPECT_EQ(signal_of(log, "/log/force").unit, "") << "name and attribute differ";
}

TEST(NamesInHdf5, OfATablesMembersAndOfColumns_LoseTheirBracketsToo) {
    const TemporaryFolder folder;
    testing::make_hdf5_table(folder / "table.h5", "run", {{"t [s]", {0.0, 1.0}}, {"x [um]", {1.0, 2.0}}});
    const Log table = read_log(folder / "table.h5", testing::no_table_options);
    EXPECT_EQ(signal_of(table, "/run.t").unit, "s");
    EXPECT_EQ(signal_of(table, "/run.x").unit, "um");
    Log columns;
    for (const char* name : {"/x [mm][1]", "/x [mm][2]"}) columns.signals.push_back({.name = name});
    take_units_off_names(columns);
    EXPECT_EQ(columns.signals[0].name, "/x[1]");
    EXPECT_EQ(columns.signals[1].name, "/x[2]");
}

TEST(LabelsOfSimulink, WithAUnitInBrackets_AreNameAndUnit) {
    const TemporaryFolder folder;
    testing::make_simulink_mat(folder / "a.mat", testing::MatFormat::five, {0.0, 1.0},
                               {{"position [mm]", {3.0, 4.0}}});
    const Log log = read_log(folder / "a.mat", testing::no_table_options);
    EXPECT_EQ(signal_of(log, "out.position").unit, "mm");
    EXPECT_EQ(signal_of(log, "out.position").times, "out.time");
}

TEST(IntegersAbove63Bits, AreDoublesAndNeverNegative) {
    const TemporaryFolder folder;
    std::vector<std::uint64_t> values{7, std::uint64_t{1} << 63U, std::numeric_limits<std::uint64_t>::max()};
    const std::vector<double> as_doubles(values.begin(), values.end());
    const hid_t file = H5Fcreate((folder / "log.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t count = values.size();
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    const hid_t set = H5Dcreate2(file, "x", H5T_STD_U64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Dwrite(set, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    H5Dclose(set);
    H5Sclose(space);
    H5Fclose(file);
    for (const auto& [name, format] :
         {std::pair("five.mat", MAT_FT_MAT5), std::pair("seven.mat", MAT_FT_MAT73)}) {
        std::array<std::size_t, 2> dims{values.size(), 1};
        write_variable(made_mat(folder / name, format),
                       Mat_VarCreate("x", MAT_C_UINT64, MAT_T_UINT64, 2, dims.data(), values.data(), 0));
    }
    for (const char* name : {"log.h5", "five.mat", "seven.mat"}) {
        SCOPED_TRACE(name);
        const Log log = read_log(folder / name, testing::no_table_options);
        ASSERT_EQ(log.signals.size(), 1U);
        EXPECT_EQ(log.signals[0].values, as_doubles);
        EXPECT_THAT(log.signals[0].whole, IsEmpty()) << "64 bits with a sign do not hold them";
    }
}

TEST(MatLimits, CellsBeyondAThousand_AreNamed) {
    const TemporaryFolder folder;
    for (const auto& [name, format] :
         {std::pair("five.mat", MAT_FT_MAT5), std::pair("seven.mat", MAT_FT_MAT73)}) {
        SCOPED_TRACE(name);
        write_variable(made_mat(folder / name, format), cells_variable("c", 1003));
        const Log log = read_log(folder / name, testing::no_table_options);
        EXPECT_THAT(signal_of(log, "c{1000}").values, ElementsAre(999.0));
        EXPECT_THAT(signal_of(log, "c{1001}").fault,
                    HasSubstr("and what follows it are passed over: of 1003 elements 1000 are read"));
    }
}

TEST(MatLimits, StructuresBeyondAThousand_AreNamed) {
    const TemporaryFolder folder;
    constexpr std::size_t count = 1002;
    const char* field = "x";
    std::array<std::size_t, 2> dims{1, count};
    for (const auto& [name, format] :
         {std::pair("five.mat", MAT_FT_MAT5), std::pair("seven.mat", MAT_FT_MAT73)}) {
        SCOPED_TRACE(name);
        matvar_t* const made = Mat_VarCreateStruct("s", 2, dims.data(), &field, 1);
        for (std::size_t k = 0; k < count; ++k)
            Mat_VarSetStructFieldByName(made, field, k, number_variable(nullptr, static_cast<double>(k)));
        write_variable(made_mat(folder / name, format), made);
        const Log log = read_log(folder / name, testing::no_table_options);
        EXPECT_THAT(signal_of(log, "s[1000].x").values, ElementsAre(999.0));
        EXPECT_THAT(signal_of(log, "s[1001]").fault, HasSubstr("of 1002 elements 1000 are read"));
    }
}

TEST(MatLimits, WhatIsNestedTooDeep_IsNamed) {
    const TemporaryFolder folder;
    for (const auto& [name, format] :
         {std::pair("five.mat", MAT_FT_MAT5), std::pair("seven.mat", MAT_FT_MAT73)}) {
        SCOPED_TRACE(name);
        matvar_t* inner = number_variable(nullptr, 1.0);
        std::array<std::size_t, 2> dims{1, 1};
        for (int depth = 0; depth < 20; ++depth)
            inner =
                Mat_VarCreate(depth == 19 ? "c" : nullptr, MAT_C_CELL, MAT_T_CELL, 2, dims.data(), &inner, 0);
        const MadeMat mat = made_mat(folder / name, format);
        write_variable(mat, inner);
        write_variable(mat, number_variable("x", 2.0));
    }
    for (const char* name : {"five.mat", "seven.mat"}) {
        SCOPED_TRACE(name);
        const Log log = read_log(folder / name, testing::no_table_options);
        EXPECT_THAT(log.signals,
                    Contains(::testing::Field(&LoggedSignal::fault,
                                              HasSubstr("in more than 16 structures and cells"))));
        EXPECT_THAT(signal_of(log, "x").values, ElementsAre(2.0));
    }
}

TEST(MatLimits, SignalsBeyondTenThousand_AreSaid) {
    const TemporaryFolder folder;
    {
        const MadeMat mat = made_mat(folder / "many.mat", MAT_FT_MAT5);
        for (int k = 0; k < 11; ++k)
            write_variable(mat, cells_variable(("c" + std::to_string(k)).c_str(), 1000));
    }
    const Log log = read_log(folder / "many.mat", testing::no_table_options);
    EXPECT_THAT(log.notes, ElementsAre("c10 and what follows it are passed over: more than 10000 signals are "
                                       "not read from one file"));
}

}  // namespace
}  // namespace fidservo::imports
