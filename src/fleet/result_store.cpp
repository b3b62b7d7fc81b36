// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/fleet/result_store.h"

#include "core/failure.h"
#include "core/input_error.h"
#include "core/result.h"
#include "src/files/disk/durable_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

namespace fidservo::fleet {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t key_digits = 16;
constexpr std::string_view ending = ".json", draft_ending = ".part";

std::optional<std::string> text_of_file(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return std::nullopt;
    std::string text(std::istreambuf_iterator<char>(stream), {});
    if (stream.bad()) throw RunFault(fmt::format("{}: cannot be read", file.string()));
    return text;
}

/// Of .STEM-KEY.json.TOKEN-PROCESS.part; empty: the file is no draft.
std::string final_name_of_draft(const std::string& file) {
    if (!file.starts_with('.') || !file.ends_with(draft_ending)) return {};
    const auto end = file.rfind(ending);
    return end == std::string::npos ? std::string() : file.substr(1, end + ending.size() - 1);
}

void sync(const fs::path& folder) {
    if (const Status synced = sync_folder(folder); !synced) throw RunFault(synced.error().text);
}

std::string random_token() {
    std::random_device source;
    return fmt::format("{:08x}{:08x}", source(), source());
}

}  // namespace

std::string stem_of_result(const std::string& file) {
    const std::size_t tail = 1 + key_digits + ending.size();
    if (file.size() <= tail || !file.ends_with(ending) || file[file.size() - tail] != '-') return {};
    return file.substr(0, file.size() - tail);
}

std::string ResultName::file() const {
    return fmt::format("{}-{}{}", stem, key.substr(0, key_digits), ending);
}

ResultStore::ResultStore(const fs::path& fleet)
    : folder_(fleet / "results"), superseded_(fleet / "superseded"), token_(random_token()) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error)
        throw InputError(fmt::format("--out: {}: cannot be made: {}", folder_.string(), error.message()));
    for (const auto& entry : fs::directory_iterator(folder_)) {
        std::string file = entry.path().filename().string();
        if (const std::string stem = stem_of_result(file); !stem.empty())
            files_[stem].push_back(std::move(file));
    }
}

std::optional<std::string> ResultStore::find(const ResultName& name) const {
    const fs::path file = folder_ / name.file();
    if (auto text = text_of_file(file)) return text;
    auto text = text_of_file(superseded_ / name.file());
    if (!text) return std::nullopt;
    publish(name, *text);
    std::error_code gone_already;
    fs::remove(superseded_ / name.file(), gone_already);
    return text;
}

fs::path ResultStore::draft_of(const ResultName& name) const {
    return folder_ / fmt::format(".{}.{}-{}{}", name.file(), token_, ::getpid(), draft_ending);
}

void ResultStore::publish(const ResultName& name, std::string_view text) const {
    const fs::path file = folder_ / name.file(), draft = draft_of(name);
    std::error_code gone_already;
    fs::remove(draft, gone_already);
    write_or_throw(draft, text);
    const int linked = ::link(draft.c_str(), file.c_str()) == 0 ? 0 : errno;
    fs::remove(draft, gone_already);
    // Whoever finds the result made may have swept this draft away.
    const bool is_there = linked == EEXIST || (linked == ENOENT && fs::exists(file));
    if (linked != 0 && !is_there)
        throw RunFault(
            fmt::format("{}: cannot be linked to its name: {}", file.string(), std::strerror(linked)));
    if (is_there && text_of_file(file) != text)
        throw RunFault(
            fmt::format("{}: is there with other bytes than were found now from the same inputs; "
                        "it was left as it is",
                        file.string()));
    sync(folder_);
    supersede_others(name);
}

void ResultStore::supersede_others(const ResultName& name) const {
    const auto own = files_.find(name.stem);
    if (own == files_.end()) return;
    for (const std::string& file : own->second) {
        if (file == name.file()) continue;
        std::error_code error;
        fs::create_directories(superseded_, error);
        fs::rename(folder_ / file, superseded_ / file, error);
        if (error && error != std::errc::no_such_file_or_directory)
            throw RunFault(fmt::format("{}: cannot be moved to {}: {}", (folder_ / file).string(),
                                       superseded_.string(), error.message()));
    }
}

void ResultStore::sweep() const {
    for (const auto& entry : fs::directory_iterator(folder_)) {
        const std::string file = entry.path().filename().string();
        const std::string result = final_name_of_draft(file);
        if (result.empty()) continue;
        std::error_code error;
        if (file.find("." + token_ + "-") != std::string::npos || fs::exists(folder_ / result, error))
            fs::remove(entry.path(), error);
    }
}

}  // namespace fidservo::fleet
