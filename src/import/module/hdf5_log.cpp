// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/module/hdf5_log.h"

#include "src/import/module/hdf5_dataset.h"
#include "src/import/module/hdf5_handle.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

namespace fidservo::imports {
namespace {

/// A file, and where its datasets are.
struct Visit {
    Hdf5Reading reading{};
    std::set<std::string> indices{};         ///< groups of PyTables for searching in a table, with a / behind
    std::map<haddr_t, std::string> names{};  ///< of datasets, by address
};

herr_t visit_object(hid_t file, const char* path, const H5O_info_t* info, void* to) {
    auto& [reading, indices, names] = *static_cast<Visit*>(to);
    const std::string name = "/" + std::string(path);
    if (info->type == H5O_TYPE_GROUP) {
        const Hdf5Handle group(H5Oopen(file, path, H5P_DEFAULT), H5Oclose);
        if (group && hdf5_attribute(group.id(), "CLASS") == "TINDEX") indices.insert(name + "/");
    }
    const bool is_of_index =
        std::ranges::any_of(indices, [&](const std::string& index) { return name.starts_with(index); });
    if (info->type != H5O_TYPE_DATASET || is_of_index) return 0;
    if (reading.usable() >= most_signals) {
        reading.fault = fmt::format("more than {} datasets: are not read from one file", most_signals);
        return 1;
    }
    names[info->addr] = name;
    const Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!dataset)
        reading.pass_over(name, "libhdf5 cannot open it");
    else
        read_hdf5_dataset(reading, dataset.id(), name);
    return 0;
}

/// Another name for a dataset, or a link that is not followed.
herr_t visit_link(hid_t file, const char* path, const H5L_info_t* info, void* to) {
    auto& [reading, indices, names] = *static_cast<Visit*>(to);
    const std::string name = "/" + std::string(path);
    if (info->type == H5L_TYPE_HARD) {
        const auto dataset = names.find(info->u.address);
        if (dataset != names.end() && dataset->second != name)
            reading.pass_over(name, fmt::format("is another name of {}: give that one", dataset->second));
        return 0;
    }
    std::string target(info->u.val_size, '\0');
    if (info->type == H5L_TYPE_SOFT && !target.empty() &&
        H5Lget_val(file, path, target.data(), target.size(), H5P_DEFAULT) >= 0)
        reading.pass_over(name, fmt::format("is a link to {}: give that name", target.c_str()));
    else
        reading.pass_over(name, "is a link into another file, which is not followed: import that file");
    return 0;
}

Hdf5Handle open_to_read(const char* file) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    return {H5Fopen(file, H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
}

}  // namespace

LogOrFault read_hdf5_file(const char* file) {
    const Hdf5Handle handle = open_to_read(file);
    if (!handle)
        return tl::make_unexpected(
            std::string("libhdf5 cannot open it: it is damaged, cut off or still being written"));
    Visit visit;
    const Hdf5Reading& reading = visit.reading;
    const herr_t visited =
        H5Ovisit2(handle.id(), H5_INDEX_NAME, H5_ITER_NATIVE, visit_object, &visit, H5O_INFO_BASIC);
    if (!reading.fault.empty()) return tl::make_unexpected(reading.fault);
    if (visited < 0 || H5Lvisit(handle.id(), H5_INDEX_NAME, H5_ITER_NATIVE, visit_link, &visit) < 0)
        return tl::make_unexpected(std::string("libhdf5 cannot list its groups: it is damaged"));
    for (const std::string& index : visit.indices)
        visit.reading.log.notes.push_back(fmt::format("{}: passed over: PyTables' index of a table", index));
    if (reading.passed_over > reading.most_named)
        visit.reading.log.notes.push_back(fmt::format("{} more datasets and links are passed over",
                                                      reading.passed_over - reading.most_named));
    const auto& signals = reading.log.signals;
    if (reading.usable() == 0 && reading.log.texts.empty())
        return tl::make_unexpected(
            "holds no dataset of numbers in one or two dimensions" +
            (signals.empty() ? std::string()
                             : fmt::format("; {} {}", signals.front().name, signals.front().fault)));
    take_units_off_names(visit.reading.log);
    return std::move(visit.reading.log);
}

}  // namespace fidservo::imports
