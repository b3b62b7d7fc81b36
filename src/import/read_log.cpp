// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/read_log.h"

#include "core/input_error.h"
#include "src/images/image_list.h"
#include "src/images/image_tally.h"
#include "src/import/bag_files.h"
#include "src/import/guarded.h"
#include "src/import/import_module.h"
#include "src/import/interrupted.h"
#include "src/import/table_log.h"
#include "vision/images/image_file.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <span>
#include <string_view>

#include <fmt/format.h>

namespace fidservo::imports {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_for(const fs::path& file, std::string_view why) {
    throw InputError(fmt::format("{}: {}", file.string(), with_visible_controls(why)));
}

/// What a file begins with; HDF5's signature may stand at 512 and its doubles.
std::string beginning_of(const fs::path& file) {
    constexpr std::size_t most_bytes = 4096;
    std::ifstream stream(file, std::ios::binary);
    if (!stream) fail_for(file, "cannot be opened");
    std::string bytes(most_bytes, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
    if (bytes.empty()) fail_for(file, "is empty");
    return bytes;
}

bool has_hdf5_signature(std::string_view bytes) {
    constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
    constexpr std::size_t first_user_block = 512;
    if (bytes.starts_with(signature)) return true;
    for (std::size_t at = first_user_block; at < bytes.size(); at *= 2)
        if (bytes.substr(at).starts_with(signature)) return true;
    return false;
}

/// The text of MATLAB's header is the program's that wrote it; what follows at 124 is the version and the
/// order of bytes.
bool is_mat5(std::string_view bytes) {
    constexpr std::size_t header = 128;
    if (bytes.size() < header) return false;
    const std::string_view version = bytes.substr(124, 4);
    return version == std::string_view("\x00\x01IM", 4) || version == std::string_view("\x01\x00MI", 4);
}

struct Foreign {
    std::string_view beginning, what;
};

constexpr std::array foreign_formats{
    Foreign{"\x89MCAP", mcap_is_converted},
    Foreign{"#ROSBAG V", "is a bag of ROS 1: rosbags-convert writes it as a bag of ROS 2, which is read"},
    Foreign{"(\xB5/\xFD", "is compressed by zstd: unzstd -o NEW FILE gives the file that is read"},
    Foreign{"\x1F\x8B", "is compressed by gzip: gunzip FILE gives the file that is read"},
    Foreign{"PK\x03\x04",
            "is a ZIP archive, as .xlsx, .npz and .slx are: save the numbers as CSV, .mat or HDF5"},
    Foreign{"TDSm", "is a TDMS file of LabVIEW: save it as text (Write To Measurement File) or as CSV"}};

/// The files of one bag as one log.
Log read_bag(const fs::path& named, const std::vector<fs::path>& files) {
    LogOrFault log = import_module(named).read_rosbag2(files, interrupt_requested);
    end_if_interrupted();
    if (!log) fail_for(named, log.error());
    log->file = named;
    if (files.size() > 1)
        log->notes.push_back(
            fmt::format("{} files of one bag are one log: {}", files.size(), listed_names(files)));
    return std::move(*log);
}

/// A camera of EuRoC's folders; its images are decoded when they are asked for.
LoggedCamera euroc_camera(const fs::path& folder, Log& log) {
    const ImageList list = list_images(std::span(&folder, 1), NameTimes::automatic);
    const ImageSeries& series = list.series.front();
    LoggedCamera camera{.name = folder.filename().string(), .is_deep = !series.deep.empty()};
    for (const ImageFrame& frame : series.frames) camera.times_ns.push_back(frame.time_ns.value_or(0));
    camera.frame = [frames = series.frames](std::size_t k) -> tl::expected<LoggedFrame, std::string> {
        if (!frames[k].damage.empty()) return tl::make_unexpected(frames[k].damage);
        auto stored = vision::read_stored(frames[k].file, frames[k].page);
        if (!stored) return tl::make_unexpected(stored.error().text);
        return LoggedFrame{.image = *std::move(stored)};
    };
    log.notes.insert(log.notes.end(), list.notes.begin(), list.notes.end());
    if (!series.missing.empty())
        log.notes.push_back(fmt::format("{}: {} of {} images are listed and not there: {}", camera.name,
                                        series.missing.size(), series.missing.size() + series.frames.size(),
                                        first_names(series.missing)));
    return camera;
}

/// EuRoC's folders: camN of images, and others with a data.csv of numbers.
Log read_folder(const fs::path& as_given) {
    const fs::path given = as_given.has_filename() ? as_given : as_given.parent_path();
    const BagFiles bag = bag_of_folder(given);
    if (!bag.files.empty()) {
        Log log = read_bag(bag.files.size() == 1 ? bag.files.front() : given, bag.files);
        log.notes.insert(log.notes.end(), bag.notes.begin(), bag.notes.end());
        return log;
    }
    const fs::path folder = fs::is_directory(given / "mav0") ? given / "mav0" : given;
    Log log{.file = given};
    std::vector<fs::path> entries;
    for (const auto& entry : fs::directory_iterator(folder)) entries.push_back(entry.path());
    std::ranges::sort(entries);
    for (const fs::path& entry : entries) {
        const fs::path index = entry / "data.csv";
        if (!fs::exists(index)) continue;
        if (fs::is_directory(entry / "data")) {
            log.cameras.push_back(euroc_camera(entry, log));
            continue;
        }
        const std::string name = entry.filename().string();
        Log table = read_table_log(index, {.are_offered = false});
        const std::string times = table.signals.empty() ? "" : name + "/" + table.signals.front().name;
        for (LoggedSignal& signal : table.signals) {
            signal.name = name + "/" + signal.name;
            if (signal.name != times) signal.times = times;
            log.signals.push_back(std::move(signal));
        }
    }
    if (log.signals.empty() && log.cameras.empty())
        fail_for(given, "is a folder without a bag (.db3) and without folders that have a data.csv");
    return log;
}

/// A log as read_log() gives it, with names as the file has them.
Log read_with_raw_names(const fs::path& file, const TableOptions& table) {
    std::error_code error;
    if (!fs::exists(file, error)) fail_for(file, "is not there");
    if (fs::is_directory(file)) return read_folder(file);
    if (!fs::is_regular_file(file)) fail_for(file, "is no file and no folder");
    const std::string beginning = beginning_of(file);
    const bool is_bag = beginning.starts_with(std::string_view("SQLite format 3\0", 16));
    if (is_bag || (is_named_as_bag(file) && file.extension() != ".db3")) {
        Log log = read_bag(file, {file});
        if (const std::size_t count = files_of_same_bag(file); count > 1)
            log.notes.push_back(fmt::format(
                "is one of {} files of a bag: the folder, or all of them by name, are read as one log",
                count));
        return log;
    }
    for (const Foreign& format : foreign_formats)
        if (beginning.starts_with(format.beginning)) fail_for(file, format.what);
    const bool is_hdf5 = has_hdf5_signature(beginning);
    if (is_mat5(beginning) || (is_hdf5 && beginning.starts_with("MATLAB")))
        return read_guarded(file, import_module(file).read_mat);
    if (is_hdf5) return read_guarded(file, import_module(file).read_hdf5);
    if (file.extension() == ".mat" || file.extension() == ".MAT")
        fail_for(file, "does not begin as MATLAB's files of formats 5 and 7.3 do: save it again with -v7");
    if (file.extension() == ".db3")
        fail_for(file, "does not begin as a database of SQLite does, which a bag of ROS 2 is");
    for (const char* ending : {".h5", ".hdf5", ".hdf"})
        if (file.extension() == ending) fail_for(file, "has no signature of HDF5");
    return read_table_log(file, table);
}

/// No name or sentence carries a control character to a terminal or into a map.
Log with_visible_names(Log log) {
    for (LoggedSignal& signal : log.signals)
        for (std::string* text : {&signal.name, &signal.unit, &signal.times, &signal.fault})
            *text = with_visible_controls(*text);
    for (LoggedCamera& camera : log.cameras) camera.name = with_visible_controls(camera.name);
    for (std::string& note : log.notes) note = with_visible_controls(note);
    std::map<std::string, std::string> texts;
    for (auto& [name, text] : log.texts) texts.try_emplace(with_visible_controls(name), std::move(text));
    log.texts = std::move(texts);
    return log;
}

}  // namespace

Log read_log(const fs::path& file, const TableOptions& table) {
    return with_visible_names(read_with_raw_names(file, table));
}

std::vector<Log> read_logs(const std::vector<fs::path>& files, const TableOptions& table) {
    std::vector<Log> logs;
    for (const std::vector<fs::path>& group : with_bags_together(files)) {
        if (group.size() == 1) {
            logs.push_back(read_log(group.front(), table));
            continue;
        }
        for (const fs::path& file : group) {
            std::error_code error;
            if (!fs::is_regular_file(file, error)) fail_for(file, "is not there, or no file");
        }
        logs.push_back(with_visible_names(read_bag(group.front(), group)));
    }
    return logs;
}

}  // namespace fidservo::imports
