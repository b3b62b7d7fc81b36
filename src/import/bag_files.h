// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Which files are a bag of ROS 2: a recorder begins a new file by size or time, BAG_0.db3, BAG_1.db3, ...
#include <filesystem>
#include <string>
#include <vector>

namespace fidservo::imports {

struct BagFiles {
    std::vector<std::filesystem::path> files{};  ///< in their order; none: it is no bag
    std::vector<std::string> notes{};            ///< sentences for the user
};

/// A bag in the format MCAP, which is not read, and how it becomes one that is.
inline constexpr const char* mcap_is_converted =
    "is a bag in the format MCAP: ros2 bag convert -i BAG -o to.yaml writes it as sqlite3 (.db3), which is "
    "read, with the line output_bags: [{ uri: NEW, storage_id: sqlite3, all: true }] in to.yaml";

/// Whether a file is named as a bag's in SQLite's format, perhaps compressed: .db3, .db3.zstd, .db3.zst.
bool is_named_as_bag(const std::filesystem::path& file);

/// The files' names without folders: "run_0.db3, run_1.db3".
std::string listed_names(const std::vector<std::filesystem::path>& files);

/// The files of a folder's bag: those that its metadata.yaml lists, in its order, or without one all, in the
/// order of their numbers. Of a file that is there compressed and decompressed the latter is taken. Throws
/// InputError: a listed one is not there, there are several bags, or it is of MCAP.
BagFiles bag_of_folder(const std::filesystem::path& folder);

/// How many files of a bag stand in a file's folder under its name with other numbers, itself counted.
std::size_t files_of_same_bag(const std::filesystem::path& file);

/// Files given by name: those of one bag together, in the order of their numbers, every other one by itself.
std::vector<std::vector<std::filesystem::path>> with_bags_together(
    const std::vector<std::filesystem::path>& files);

}  // namespace fidservo::imports
