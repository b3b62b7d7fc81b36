// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/bag_files.h"

#include "core/input_error.h"
#include "src/files/text/yaml_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace fidservo::imports {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 2> zstd_endings{".zstd", ".zst"};

fs::path without_zstd(const fs::path& file) {
    return std::ranges::find(zstd_endings, file.extension().string()) == zstd_endings.end()
               ? file
               : fs::path(file).replace_extension();
}

/// The bag that a file is named after, and its number: of run_2.db3 "run" and 2; of run.db3 "run" and 0.
struct BagName {
    std::string bag;
    std::uint32_t number = 0;
};
BagName name_in_bag(const fs::path& file) {
    const std::string stem = without_zstd(file).stem().string();
    const std::size_t line = stem.rfind('_');
    if (line == std::string::npos) return {stem};
    std::uint32_t number = 0;
    const char* const end = stem.data() + stem.size();
    const auto read = std::from_chars(stem.data() + line + 1, end, number);
    if (read.ec != std::errc() || read.ptr != end) return {stem};
    return {stem.substr(0, line), number};
}

/// The folder's files that are named as bags, decompressed ones before compressed ones, by name.
std::vector<fs::path> files_named_as_bags(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> files;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (is_named_as_bag(entry->path())) files.push_back(entry->path());
    if (error) throw InputError(fmt::format("{}: cannot be read: {}", folder.string(), error.message()));
    std::ranges::sort(files);
    const std::vector<fs::path> all = files;
    std::erase_if(files, [&](const fs::path& file) {
        const fs::path other = without_zstd(file);
        return other != file && std::ranges::find(all, other) != all.end();
    });
    return files;
}

fs::path listed_file(const fs::path& folder, const YamlValue& entry) {
    const fs::path file = folder / fs::path(entry.text()).filename();
    if (file.extension() == ".mcap")
        throw InputError(fmt::format("{}: {}", folder.string(), mcap_is_converted));
    std::error_code error;
    for (const fs::path& one : {without_zstd(file), file})
        if (fs::is_regular_file(one, error)) return one;
    entry.fail("this file of the bag is not there; the others are read where they are given by name");
}

/// The files that metadata.yaml lists; none: it is no bag's.
std::vector<fs::path> listed_files(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code error;
    if (!fs::is_regular_file(folder / "metadata.yaml", error)) return files;
    const YamlValue metadata = YamlValue::load(folder / "metadata.yaml");
    const auto bag = metadata.find("rosbag2_bagfile_information");
    if (!bag || !bag->is_map()) return files;
    for (const YamlValue& entry : bag->at("relative_file_paths").items())
        files.push_back(listed_file(folder, entry));
    return files;
}

}  // namespace

bool is_named_as_bag(const fs::path& file) {
    return without_zstd(file).extension() == ".db3";
}

std::string listed_names(const std::vector<fs::path>& files) {
    std::string names;
    for (const fs::path& file : files) names += (names.empty() ? "" : ", ") + file.filename().string();
    return names;
}

BagFiles bag_of_folder(const fs::path& folder) {
    BagFiles bag{.files = listed_files(folder), .notes = {}};
    const std::vector<fs::path> all = files_named_as_bags(folder);
    if (!bag.files.empty()) {
        for (const fs::path& file : all)
            if (std::ranges::find(bag.files, file) == bag.files.end())
                bag.notes.push_back(
                    fmt::format("{}: passed over: metadata.yaml does not list it", file.filename().string()));
        return bag;
    }
    bag.files = all;
    std::ranges::stable_sort(bag.files, {}, [](const fs::path& file) { return name_in_bag(file).number; });
    const auto is_another = [](const fs::path& a, const fs::path& b) {
        const BagName first = name_in_bag(a), second = name_in_bag(b);
        return first.bag != second.bag || first.number == second.number;
    };
    if (std::ranges::adjacent_find(bag.files, is_another) != bag.files.end())
        throw InputError(fmt::format("{}: holds files of several bags: {}; give those of one by name",
                                     folder.string(), listed_names(all)));
    if (all.empty() && std::ranges::any_of(fs::directory_iterator(folder), [](const auto& entry) {
            return entry.path().extension() == ".mcap";
        }))
        throw InputError(fmt::format("{}: {}", folder.string(), mcap_is_converted));
    return bag;
}

std::size_t files_of_same_bag(const fs::path& file) {
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const std::string bag = name_in_bag(file).bag;
    return static_cast<std::size_t>(std::ranges::count_if(
        files_named_as_bags(folder), [&](const fs::path& one) { return name_in_bag(one).bag == bag; }));
}

std::vector<std::vector<fs::path>> with_bags_together(const std::vector<fs::path>& files) {
    std::vector<std::vector<fs::path>> groups;
    std::map<std::pair<fs::path, std::string>, std::size_t> group_of_bag;
    for (const fs::path& file : files) {
        std::error_code error;
        if (!is_named_as_bag(file) || fs::is_directory(file, error)) {
            groups.push_back({file});
            continue;
        }
        const std::pair bag(fs::absolute(file).lexically_normal().parent_path(), name_in_bag(file).bag);
        const auto [place, is_new] = group_of_bag.try_emplace(bag, groups.size());
        if (is_new) groups.emplace_back();
        const std::uint32_t number = name_in_bag(file).number;
        const bool is_twice = std::ranges::any_of(groups[place->second], [&](const fs::path& other) {
            return name_in_bag(other).number == number;
        });
        if (is_twice)
            groups.push_back({file});
        else
            groups[place->second].push_back(file);
    }
    for (std::vector<fs::path>& group : groups)
        std::ranges::stable_sort(group, {}, [](const fs::path& file) { return name_in_bag(file).number; });
    return groups;
}

}  // namespace fidservo::imports
