// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The files of a ROS 2 bag. A recorder begins a new file after a given size or time: BAG_0.db3, BAG_1.db3,
// ...
#include <filesystem>
#include <string>
#include <vector>

namespace fidservo::imports {

struct BagFiles {
    std::vector<std::filesystem::path> files{};  ///< in their order; none: it is no bag
    std::vector<std::string> notes{};            ///< sentences for the user
};

/// The message for a bag in the format MCAP, which cannot be read, with the way to convert it.
inline constexpr const char* mcap_is_converted =
    "is a bag in the format MCAP: ros2 bag convert -i BAG -o to.yaml writes it as sqlite3 (.db3), which is "
    "read, with the line output_bags: [{ uri: NEW, storage_id: sqlite3, all: true }] in to.yaml";

/// Whether a file has the name of a bag in SQLite's format, compressed or not: .db3, .db3.zstd, .db3.zst.
bool is_named_as_bag(const std::filesystem::path& file);

/// The files' names without folders: "run_0.db3, run_1.db3".
std::string listed_names(const std::vector<std::filesystem::path>& files);

/// The files of the bag in a folder: those that its metadata.yaml lists, in that order; without metadata.yaml
/// all, in the order of their numbers. If a file exists both compressed and decompressed, the latter is
/// taken. Throws InputError if a listed file does not exist, if there are several bags, or if the bag is in
/// the format MCAP.
BagFiles bag_of_folder(const std::filesystem::path& folder);

/// The number of files in a file's folder that have the same name but for their numbers, the file itself
/// included.
std::size_t files_of_same_bag(const std::filesystem::path& file);

/// Groups files: the files of one bag form a group, in the order of their numbers; every other file is a
/// group of its own.
std::vector<std::vector<std::filesystem::path>> with_bags_together(
    const std::vector<std::filesystem::path>& files);

}  // namespace fidservo::imports
