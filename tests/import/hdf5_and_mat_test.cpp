// SPDX-License-Identifier: GPL-3.0-or-later
// HDF5 and MATLAB's files as programs other than this one's exports and MATLAB write them.
#include "src/import/read_log.h"
#include "tests/import/made_files.h"
#include "tests/src/message_of.h"
#include "tests/src/temporary_folder.h"

#include <array>
#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

namespace fidservo::imports {
namespace {

using fidservo::testing::message_of;
using fidservo::testing::TemporaryFolder;
using fidservo::testing::text_of;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsNan;
using ::testing::Not;

/// A file of HDF5 while it is made.
class MadeHdf5 {
  public:
    explicit MadeHdf5(const std::filesystem::path& file, hsize_t user_block = 0) {
        const hid_t access = H5Pcreate(H5P_FILE_CREATE);
        H5Pset_userblock(access, user_block);
        file_ = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, access, H5P_DEFAULT);
        H5Pclose(access);
    }
    ~MadeHdf5() { H5Fclose(file_); }
    MadeHdf5(const MadeHdf5&) = delete;
    MadeHdf5& operator=(const MadeHdf5&) = delete;
    hid_t id() const { return file_; }

    void group(const char* name) { H5Gclose(H5Gcreate2(file_, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)); }
    /// Without data if there are none.
    void dataset(const char* name, hid_t type, const std::vector<hsize_t>& dims, const void* data = nullptr) {
        const hid_t space = H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr);
        const hid_t made = H5Dcreate2(file_, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        EXPECT_GE(made, 0) << name;
        if (data != nullptr) {
            EXPECT_GE(H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), 0) << name;
        }
        H5Dclose(made);
        H5Sclose(space);
    }
    void doubles(const char* name, const std::vector<double>& values) {
        dataset(name, H5T_NATIVE_DOUBLE, {values.size()}, values.data());
    }
    void attribute(const char* object, const char* name, hid_t type, const void* value) {
        const hid_t scalar = H5Screate(H5S_SCALAR);
        const hid_t made =
            H5Acreate_by_name(file_, object, name, type, scalar, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        EXPECT_GE(H5Awrite(made, type, value), 0) << name;
        H5Aclose(made);
        H5Sclose(scalar);
    }
    void number(const char* object, const char* name, double value) {
        attribute(object, name, H5T_NATIVE_DOUBLE, &value);
    }
    /// Of just its letters, as NumPy's strings of a fixed length are.
    void text(const char* object, const char* name, const std::string& value,
              H5T_str_t padding = H5T_STR_NULLPAD) {
        const hid_t type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, value.size());
        H5Tset_strpad(type, padding);
        attribute(object, name, type, value.data());
        H5Tclose(type);
    }

  private:
    hid_t file_ = -1;
};

/// What is said of a signal that cannot be used.
std::string fault_of(const Log& log, const std::string& name) {
    const LoggedSignal* signal = log.find(name);
    return signal == nullptr ? "there is no such signal" : signal->fault;
}

std::vector<double> values_of(const Log& log, const std::string& name) {
    const LoggedSignal* signal = log.find(name);
    EXPECT_NE(signal, nullptr) << name;
    return signal == nullptr ? std::vector<double>() : signal->values;
}

TEST(Hdf5Log, DatasetsWithoutElements_AreEmptyAndHideNoOthers) {
    const TemporaryFolder folder;
    {
        MadeHdf5 made(folder / "e.h5");
        made.doubles("x", {1, 2});
        made.dataset("none", H5T_NATIVE_DOUBLE, {0, 0});
        made.dataset("rows", H5T_NATIVE_DOUBLE, {0, 3});
    }
    const Log log = read_log(folder / "e.h5", testing::no_table_options);
    EXPECT_THAT(values_of(log, "/x"), ElementsAre(1, 2));
    EXPECT_THAT(values_of(log, "/none"), IsEmpty());
    EXPECT_THAT(values_of(log, "/rows"), IsEmpty());
}

TEST(Hdf5Log, MembersOfCompounds_AreSignalsInArraysTruthValuesAndCompounds) {
    struct Row {
        double t;
        std::array<float, 2> block;
        signed char is_on;
        unsigned char bit;
        struct {
            std::int64_t ns;
        } inner;
        std::array<char, 4> word;
    };
    const std::vector<Row> rows{{0.0, {1.0F, 10.0F}, 0, 1, {(std::int64_t{1} << 60U) + 1}, {}},
                                {0.5, {2.0F, 20.0F}, 1, 0, {5}, {}},
                                {1.0, {3.0F, 30.0F}, 1, 1, {7}, {}}};
    const TemporaryFolder folder;
    {
        MadeHdf5 made(folder / "c.h5");
        const hsize_t two = 2;
        const hid_t pair = H5Tarray_create2(H5T_NATIVE_FLOAT, 1, &two),
                    truth = H5Tenum_create(H5T_NATIVE_SCHAR);
        signed char value = 0;
        H5Tenum_insert(truth, "FALSE", &value);
        H5Tenum_insert(truth, "TRUE", &++value);
        const hid_t inner = H5Tcreate(H5T_COMPOUND, sizeof(std::int64_t)), word = H5Tcopy(H5T_C_S1);
        H5Tinsert(inner, "ns", 0, H5T_NATIVE_INT64);
        H5Tset_size(word, 4);
        const hid_t type = H5Tcreate(H5T_COMPOUND, sizeof(Row));
        H5Tinsert(type, "t", offsetof(Row, t), H5T_NATIVE_DOUBLE);
        H5Tinsert(type, "values_block_0", offsetof(Row, block), pair);
        H5Tinsert(type, "is_on", offsetof(Row, is_on), truth);
        H5Tinsert(type, "bit", offsetof(Row, bit), H5T_NATIVE_B8);
        H5Tinsert(type, "inner", offsetof(Row, inner), inner);
        H5Tinsert(type, "word", offsetof(Row, word), word);
        made.dataset("run", type, {rows.size()}, rows.data());
        const std::array<signed char, 2> flags{1, 0};
        made.dataset("flags", truth, {flags.size()}, flags.data());
        for (const hid_t one : {pair, truth, inner, word, type}) H5Tclose(one);
    }
    const Log log = read_log(folder / "c.h5", testing::no_table_options);
    EXPECT_THAT(values_of(log, "/run.t"), ElementsAre(0.0, 0.5, 1.0));
    EXPECT_THAT(values_of(log, "/run.values_block_0[1]"), ElementsAre(1, 2, 3));
    EXPECT_THAT(values_of(log, "/run.values_block_0[2]"), ElementsAre(10, 20, 30));
    EXPECT_THAT(values_of(log, "/run.is_on"), ElementsAre(0, 1, 1));
    EXPECT_THAT(values_of(log, "/run.bit"), ElementsAre(1, 0, 1));
    ASSERT_NE(log.find("/run.inner.ns"), nullptr);
    EXPECT_THAT(log.find("/run.inner.ns")->whole, ElementsAre((std::int64_t{1} << 60U) + 1, 5, 7));
    EXPECT_THAT(fault_of(log, "/run.word"), HasSubstr("holds texts"));
    EXPECT_THAT(values_of(log, "/flags"), ElementsAre(1, 0));
}

TEST(Hdf5Log, ConventionsOfCf_AreFollowedAndSaid) {
    const TemporaryFolder folder;
    {
        MadeHdf5 made(folder / "cf.h5");
        const std::array<short, 3> packed{5000, -1, 0};
        made.dataset("x", H5T_NATIVE_SHORT, {packed.size()}, packed.data());
        made.number("x", "scale_factor", 0.002);
        made.number("x", "add_offset", 50.0);
        const short fill = -1;
        made.attribute("x", "_FillValue", H5T_NATIVE_SHORT, &fill);
        const std::array<float, 2> large{1e20F, 4.0F};
        made.dataset("y", H5T_NATIVE_FLOAT, {large.size()}, large.data());
        made.number("y", "missing_value", 1e20);
        made.doubles("z", {1, 2});
        made.text("z", "scale_factor", "two");
        const std::array<std::int64_t, 2> times{(std::int64_t{1} << 60U) + 1, (std::int64_t{1} << 60U) + 2};
        made.dataset("t", H5T_NATIVE_INT64, {times.size()}, times.data());
        made.number("t", "_FillValue", -1.0);
    }
    const Log log = read_log(folder / "cf.h5", testing::no_table_options);
    EXPECT_THAT(values_of(log, "/x"), ElementsAre(60.0, IsNan(), 50.0));
    EXPECT_THAT(values_of(log, "/y"), ElementsAre(IsNan(), 4.0));
    EXPECT_THAT(fault_of(log, "/z"), HasSubstr("its attribute scale_factor is not one finite number"));
    EXPECT_THAT(log.find("/t")->whole,
                ElementsAre((std::int64_t{1} << 60U) + 1, (std::int64_t{1} << 60U) + 2));
    EXPECT_THAT(log.notes,
                Contains(HasSubstr("/x: scale_factor 0.002 is applied; add_offset 50 is applied; 1 "
                                   "samples are missing: their number is -1")));
    EXPECT_THAT(log.notes, Not(Contains(HasSubstr("/t: "))));
}

TEST(Hdf5Log, Units_MayHaveBlanksAndMustAgree) {
    const TemporaryFolder folder;
    {
        MadeHdf5 made(folder / "u.h5");
        for (const char* name : {"blank", "filled", "two", "x_mm", "y_mm"}) made.doubles(name, {1, 2});
        made.text("blank", "units", " mm  ");
        made.text("filled", "units", "furlong ", H5T_STR_SPACEPAD);
        made.text("two", "unit", "mm");
        made.text("two", "units", "um");
        made.text("x_mm", "units", "um");
        made.text("y_mm", "units", "millimeters");
    }
    const Log log = read_log(folder / "u.h5", testing::no_table_options);
    EXPECT_EQ(log.find("/blank")->unit, "mm");
    EXPECT_EQ(log.find("/filled")->unit, "furlong");
    EXPECT_EQ(log.find("/two")->unit, "");
    EXPECT_EQ(log.find("/x_mm")->unit, "");
    EXPECT_EQ(log.find("/y_mm")->unit, "mm");
    EXPECT_THAT(log.notes, Contains("/two: its attribute unit states the unit mm, but its attribute units "
                                    "states um: the map has to state it"));
    EXPECT_THAT(log.notes, Contains("/x_mm: its attribute units states the unit um, but its name states mm: "
                                    "the map has to state it"));
}

TEST(Hdf5Log, WhatIsPassedOver_IsNamedWithTheReason) {
    const TemporaryFolder folder;
    {
        MadeHdf5 made(folder / "p.h5");
        made.doubles("x", {1, 2, 3, 4});
        const std::vector<double> eight(8, 0.5);
        made.dataset("cube", H5T_NATIVE_DOUBLE, {2, 2, 2}, eight.data());
        made.dataset("line", H5T_NATIVE_DOUBLE, {1, 1, 8}, eight.data());
        made.dataset("huge", H5T_NATIVE_DOUBLE, {most_values + 1});
        const hid_t list = H5Tvlen_create(H5T_NATIVE_DOUBLE);
        made.dataset("lists", list, {3});
        H5Tclose(list);
        H5Lcreate_soft("/x", made.id(), "soft", H5P_DEFAULT, H5P_DEFAULT);
        H5Lcreate_hard(made.id(), "x", made.id(), "z", H5P_DEFAULT, H5P_DEFAULT);
        H5Lcreate_external("other.h5", "/x", made.id(), "outside", H5P_DEFAULT, H5P_DEFAULT);
        made.group("_i_run");
        made.text("_i_run", "CLASS", "TINDEX");
        made.doubles("_i_run/sorted", {1, 2});
    }
    const Log log = read_log(folder / "p.h5", testing::no_table_options);
    const std::string first = log.find("/x")->fault.empty() ? "/x" : "/z";
    EXPECT_THAT(values_of(log, first), ElementsAre(1, 2, 3, 4));
    EXPECT_THAT(fault_of(log, first == "/x" ? "/z" : "/x"), HasSubstr("is another name of " + first));
    EXPECT_THAT(fault_of(log, "/cube"), HasSubstr("has 3 dimensions; at most 2 are read"));
    EXPECT_EQ(values_of(log, "/line").size(), 8u);
    EXPECT_THAT(fault_of(log, "/huge"), HasSubstr("with its 268435457 numbers the file would have more"));
    EXPECT_THAT(fault_of(log, "/lists"), HasSubstr("lists of lengths of their own"));
    EXPECT_THAT(fault_of(log, "/soft"), HasSubstr("is a link to /x: give that name"));
    EXPECT_THAT(fault_of(log, "/outside"), HasSubstr("is a link into another file"));
    EXPECT_EQ(log.find("/_i_run/sorted"), nullptr);
    EXPECT_THAT(log.notes, Contains(HasSubstr("/_i_run/: passed over: PyTables' index")));
}

TEST(MatLog, CompressedData_AreCheckedToTheirEnd) {
    const TemporaryFolder folder;
    std::vector<double> values(3000);
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = std::sin(0.37 * static_cast<double>(k * k));
    testing::make_plain_mat(folder / "m.mat", testing::MatFormat::five, {{"x", values}});
    const std::string bytes = text_of(folder / "m.mat");
    constexpr std::size_t first_element = 136;
    EXPECT_THAT(values_of(read_log(folder / "m.mat", testing::no_table_options), "x"),
                ::testing::ContainerEq(values));
    for (std::size_t k = 0; k < 12; ++k) {
        std::string wrong = bytes;
        const std::size_t at = first_element + (k + 1) * (bytes.size() - first_element - 1) / 12;
        wrong[at] = static_cast<char>(wrong[at] ^ (1 << k % 8));
        const auto file = folder.write("wrong.mat", wrong);
        EXPECT_THAT(message_of([&] { read_log(file, testing::no_table_options); }),
                    HasSubstr("wrong.mat: is damaged: the compressed data of its element 1"))
            << "byte " << at;
    }
    std::string wrong = bytes;
    wrong[128] = 11;  // the element's type
    const auto file = folder.write("type.mat", wrong);
    EXPECT_THAT(message_of([&] { read_log(file, testing::no_table_options); }),
                HasSubstr("its element 1 is of type 11"));
}

/// A file of format 7.3 as h5py and hdf5storage write it: attributes without a terminating zero, structures
/// that do not list their fields.
void make_mat73(const std::filesystem::path& file) {
    constexpr hsize_t user_block = 512;
    {
        MadeHdf5 made(file, user_block);
        const std::vector<double> t{0, 1, 2};
        const std::vector<float> u{5, 6, 7};
        const std::vector<double> table{1, 2, 3, 4, 5, 6};
        const std::vector<unsigned char> on{0, 1, 1};
        made.dataset("t", H5T_NATIVE_DOUBLE, {1, 3}, t.data());
        made.text("t", "MATLAB_class", "double");
        made.dataset("u", H5T_NATIVE_FLOAT, {1, 3}, u.data());
        made.text("u", "MATLAB_class", "single");
        made.dataset("on", H5T_NATIVE_UINT8, {3, 1}, on.data());
        made.text("on", "MATLAB_class", "logical");
        made.group("s");
        made.text("s", "MATLAB_class", "struct");
        made.dataset("s/x_mm", H5T_NATIVE_DOUBLE, {1, 3}, t.data());
        made.text("s/x_mm", "MATLAB_class", "double");
        made.dataset("s/table", H5T_NATIVE_DOUBLE, {2, 3}, table.data());
        made.text("s/table", "MATLAB_class", "double");
        made.group("s/inner");
        made.dataset("s/inner/y", H5T_NATIVE_DOUBLE, {1, 3}, t.data());
        made.group("sparse");
        made.text("sparse", "MATLAB_class", "double");
        made.number("sparse", "MATLAB_sparse", 3.0);
        made.dataset("huge", H5T_NATIVE_DOUBLE, {1, most_values + 1});
        made.text("huge", "MATLAB_class", "double");
        made.group("#refs#");
        made.dataset("#refs#/a", H5T_NATIVE_DOUBLE, {1, 3}, t.data());
        hobj_ref_t reference = 0;
        H5Rcreate(&reference, made.id(), "#refs#/a", H5R_OBJECT, -1);
        made.dataset("cells", H5T_STD_REF_OBJ, {1, 1}, &reference);
        made.text("cells", "MATLAB_class", "cell");
    }
    std::string header = "MATLAB 7.3 MAT-file";
    header.resize(124, ' ');
    header += std::string("\x00\x02IM", 4);
    std::fstream(file, std::ios::binary | std::ios::in | std::ios::out) << header;
}

TEST(MatLog, Format73OfOtherPrograms_IsReadInFull) {
    const TemporaryFolder folder;
    make_mat73(folder / "o.mat");
    const Log log = read_log(folder / "o.mat", testing::no_table_options);
    EXPECT_THAT(values_of(log, "t"), ElementsAre(0, 1, 2));
    EXPECT_THAT(values_of(log, "u"), ElementsAre(5, 6, 7));
    EXPECT_THAT(values_of(log, "on"), ElementsAre(0, 1, 1));
    EXPECT_THAT(values_of(log, "s.x_mm"), ElementsAre(0, 1, 2));
    EXPECT_EQ(log.find("s.x_mm")->unit, "mm");
    EXPECT_THAT(values_of(log, "s.table[2]"), ElementsAre(4, 5, 6));
    EXPECT_THAT(values_of(log, "s.inner.y"), ElementsAre(0, 1, 2));
    EXPECT_THAT(values_of(log, "cells{1}"), ElementsAre(0, 1, 2));
    EXPECT_THAT(fault_of(log, "sparse"), HasSubstr("is a sparse matrix, which is not read"));
    EXPECT_THAT(fault_of(log, "sparse"), HasSubstr("s = full(sparse); save("));
    EXPECT_THAT(fault_of(log, "huge"), HasSubstr("with its 268435457 numbers the file would have more"));
}

}  // namespace
}  // namespace fidservo::imports
