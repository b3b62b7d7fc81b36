// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/import/read_log.h"

#include "core/input_error.h"
#include "src/images/image_list.h"
#include "src/import/guarded.h"
#include "src/import/import_module.h"
#include "src/import/table_log.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <span>
#include <string_view>

#include <fmt/format.h>

namespace fidservo::imports {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_for(const fs::path& file, std::string_view why) {
    throw InputError(fmt::format("{}: {}", file.string(), why));
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
    Foreign{"\x89MCAP", "is an MCAP file: ros2 bag convert writes it as sqlite3 (.db3), which is read"},
    Foreign{"#ROSBAG V", "is a bag of ROS 1: rosbags-convert writes it as a bag of ROS 2, which is read"},
    Foreign{"(\xB5/\xFD", "is compressed by zstd: unzstd FILE gives the file that is read"},
    Foreign{"\x1F\x8B", "is compressed by gzip: gunzip FILE gives the file that is read"},
    Foreign{"PK\x03\x04",
            "is a ZIP archive, as .xlsx, .npz and .slx are: save the numbers as CSV, .mat or HDF5"},
    Foreign{"TDSm", "is a TDMS file of LabVIEW: save it as text (Write To Measurement File) or as CSV"}};

/// The database file or files of a bag's folder.
fs::path bag_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".db3") files.push_back(entry.path());
    if (files.empty()) return {};
    if (files.size() > 1)
        fail_for(folder, fmt::format("holds {} files of a bag; give them by name", files.size()));
    return files.front();
}

/// EuRoC's folders: camN of images, and others with a data.csv of numbers.
Log read_folder(const fs::path& given) {
    if (const fs::path bag = bag_in(given); !bag.empty()) return read_log(bag, {});
    const fs::path folder = fs::is_directory(given / "mav0") ? given / "mav0" : given;
    Log log{.file = given};
    std::vector<fs::path> entries;
    for (const auto& entry : fs::directory_iterator(folder)) entries.push_back(entry.path());
    std::ranges::sort(entries);
    for (const fs::path& entry : entries) {
        const fs::path index = entry / "data.csv";
        if (!fs::exists(index)) continue;
        const std::string name = entry.filename().string();
        if (fs::is_directory(entry / "data")) {
            const ImageList list = list_images(std::span(&entry, 1), NameTimes::automatic);
            LoggedCamera camera{.name = name};
            std::vector<ImageFrame> frames = list.series.front().frames;
            for (const ImageFrame& frame : frames) camera.times_ns.push_back(frame.time_ns.value_or(0));
            camera.frame = [frames](std::size_t k) -> tl::expected<LoggedFrame, std::string> {
                ImageFrame frame = frames[k];
                if (!load(frame)) return tl::make_unexpected(frame.damage);
                return LoggedFrame{.grey = frame.decoded};
            };
            log.cameras.push_back(std::move(camera));
            log.notes.insert(log.notes.end(), list.notes.begin(), list.notes.end());
            continue;
        }
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

}  // namespace

Log read_log(const fs::path& file, const TableOptions& table) {
    std::error_code error;
    if (!fs::exists(file, error)) fail_for(file, "is not there");
    if (fs::is_directory(file)) return read_folder(file);
    if (!fs::is_regular_file(file)) fail_for(file, "is no file and no folder");
    const std::string beginning = beginning_of(file);
    for (const Foreign& format : foreign_formats)
        if (beginning.starts_with(format.beginning)) fail_for(file, format.what);
    if (beginning.starts_with(std::string_view("SQLite format 3\0", 16))) {
        LogOrFault log = import_module(file).read_rosbag2(file.c_str());
        if (!log) fail_for(file, log.error());
        log->file = file;
        return std::move(*log);
    }
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

}  // namespace fidservo::imports
