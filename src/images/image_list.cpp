// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/images/image_list.h"

#include "core/input_error.h"
#include "core/result.h"
#include "src/files/recording/reader.h"
#include "src/images/image_times.h"
#include "vision/images/image_file.h"
#include "vision/images/regular_file.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_names = 3;  ///< in a line

/// The first few names, and how many there are.
std::string some_of(std::span<const std::string> names) {
    std::string text = fmt::format("{}", fmt::join(names.first(std::min(most_names, names.size())), ", "));
    if (names.size() > most_names) text += fmt::format(", ... ({} in all)", names.size());
    return text;
}

/// The folder of a camera's index (an EuRoC data set keeps cam0 in mav0); empty if there is none.
fs::path indexed_camera(const fs::path& folder) {
    for (const fs::path& camera : {folder / "cam0", folder / "mav0" / "cam0"})
        if (fs::exists(camera / "data.csv")) return camera;
    return fs::exists(folder / "data.csv") && fs::is_directory(folder / "data") ? folder : fs::path();
}

/// TUM's list of a folder's colour images, beside the folder `rgb` that holds them.
fs::path tum_list(const fs::path& folder) {
    const fs::path list = folder / "rgb.txt";
    return fs::exists(list) && fs::is_directory(folder / "rgb") ? list : fs::path();
}

bool by_natural_order(const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
}

bool is_camera_folder(const std::string& name) {
    constexpr std::string_view prefix = "cam";
    return name.starts_with(prefix) && name.size() > prefix.size() &&
           std::ranges::all_of(name.substr(prefix.size()), [](char c) { return c >= '0' && c <= '9'; });
}

class Lister {
  public:
    explicit Lister(NameTimes name_times) : name_times_(name_times) {}

    void add(const fs::path& input) {
        std::error_code error;
        if (!fs::exists(input, error))
            throw InputError(fmt::format("{}: there is no such file or folder", input.string()));
        if (!fs::is_directory(input)) return add_file(input);
        if (const fs::path camera = indexed_camera(input); !camera.empty())
            return add_index(camera, camera / "data.csv");
        if (fs::exists(input / "recording.yaml"))
            throw InputError(fmt::format("{}: the recording has no frames (cam0/data.csv)", input.string()));
        if (const fs::path list = tum_list(input); !list.empty()) return add_index(input, list);
        add_folder(input);
    }

    ImageList end() {
        if (given_by_name_) {
            ImageSeries& series = list_.series[*given_by_name_];
            take_times(title_of(series), series);
        }
        return std::move(list_);
    }

  private:
    void add_file(const fs::path& file) {
        if (const Status there = vision::demand_regular_file(file); !there)
            throw InputError(fmt::format("{}: {}", file.string(), there.error().text));
        if (is_named_as_video(file)) {
            list_.series.push_back({.name = file.string(), .video = file});
            return;
        }
        if (!given_by_name_) {
            given_by_name_ = list_.series.size();
            list_.series.push_back({.name = file.string()});
        }
        ImageSeries& series = list_.series[*given_by_name_];
        ++series.files_by_name;
        add_pictures(file, {.series = *given_by_name_}, series);
    }

    /// Adds the pictures of a file: one frame, or one a page.
    void add_pictures(const fs::path& file, ImageFrame frame, ImageSeries& series) {
        const auto pages = vision::list_pages(file);
        if (!pages) throw InputError(pages.error().text);
        for (std::size_t k = 0; k < pages->size(); ++k) {
            const vision::PageOfFile& page = (*pages)[k];
            frame.name = pages->size() == 1 ? file.string() : fmt::format("{}#{}", file.string(), k);
            frame.file = file;
            frame.page = page.page;
            frame.damage = page.damage.empty() ? "" : fmt::format("{}: {}", frame.name, page.damage);
            series.frames.push_back(frame);
            if (page.is_deep) series.deep.push_back({file, page.page});
            if (!page.note.empty()) list_.notes.push_back(fmt::format("{}: {}", file.string(), page.note));
        }
    }

    void take_times(const std::string& whose, ImageSeries& series) {
        if (auto note = take_times_of_names(whose, name_times_, series.frames); !note.empty())
            list_.notes.push_back(std::move(note));
    }

    void add_index(const fs::path& camera, const fs::path& index) {
        ImageSeries series{.name = camera.string()};
        for (const FrameName& frame : read_frame_names(index)) {
            const fs::path folder = index.filename() == "data.csv" ? camera / "data" : camera;
            const fs::path file = folder / frame.filename;
            std::error_code error;
            if (!fs::exists(file, error)) {
                series.missing.push_back(file.string());
                continue;
            }
            ImageSeries pictures;
            add_pictures(file,
                         {.series = list_.series.size(), .time_ns = frame.time_ns, .from_recording = true},
                         pictures);
            if (pictures.frames.size() > 1)
                list_.notes.push_back(
                    fmt::format("{}: the first of its {} pages is read: the index has one time",
                                file.string(), pictures.frames.size()));
            pictures.frames.front().name = file.string();
            series.frames.push_back(pictures.frames.front());
            series.deep.insert(series.deep.end(), pictures.deep.begin(),
                               pictures.deep.begin() + (pictures.deep.empty() ? 0 : 1));
        }
        if (series.frames.empty() && series.missing.empty())
            throw InputError(fmt::format("{}: names no frame", index.string()));
        list_.series.push_back(std::move(series));
        note_other_cameras(camera);
    }

    void note_other_cameras(const fs::path& camera) {
        std::vector<std::string> others;
        if (camera.filename() != "cam0") return;
        for (const auto& entry :
             fs::directory_iterator(camera.has_parent_path() ? camera.parent_path() : "."))
            if (entry.path().filename() != "cam0" && is_camera_folder(entry.path().filename().string()) &&
                entry.is_directory())
                others.push_back(entry.path().filename().string());
        std::ranges::sort(others, natural_less);
        if (!others.empty())
            list_.notes.push_back(fmt::format("{}: cam0 is read; not read: {}: give its folder for that",
                                              camera.parent_path().string(), some_of(others)));
    }

    void add_folder(const fs::path& folder) {
        const FolderOfImages found = look_into(folder);
        std::vector<fs::path> recordings;
        for (const std::string& name : found.folders)
            if (!indexed_camera(folder / name).empty()) recordings.push_back(indexed_camera(folder / name));
        if (!recordings.empty()) {
            for (const fs::path& camera : recordings) add_index(camera, camera / "data.csv");
            if (!found.images.empty())
                list_.notes.push_back(
                    fmt::format("{}: holds recordings, which are read; passed over: {} images",
                                folder.string(), found.images.size()));
            return;
        }
        if (!found.images.empty()) return add_images(folder, found);
        add_only_camera(folder, found);
    }

    void add_images(const fs::path& folder, const FolderOfImages& found) {
        ImageSeries series{.name = folder.string()};
        for (const fs::path& file : found.images) add_pictures(file, {.series = list_.series.size()}, series);
        take_times(folder.string(), series);
        list_.series.push_back(std::move(series));
        std::vector<std::string> passed_over = found.others;
        passed_over.insert(passed_over.end(), found.videos.begin(), found.videos.end());
        for (const std::string& name : found.folders) passed_over.push_back(name + "/");
        if (!passed_over.empty())
            list_.notes.push_back(fmt::format("{}: passed over: {}", folder.string(), some_of(passed_over)));
    }

    /// kalibr's bag extractor writes cam0/TIME.png, cam1/TIME.png ..., without an index.
    void add_only_camera(const fs::path& folder, const FolderOfImages& found) {
        std::vector<std::string> with_images;
        std::vector<fs::path> cameras;
        for (const std::string& name : found.folders) {
            fs::path inside = folder / name;
            FolderOfImages of_it = look_into(inside);
            if (of_it.images.empty() && is_camera_folder(name) && fs::is_directory(inside / "data")) {
                inside /= "data";
                of_it = look_into(inside);
            }
            if (of_it.images.empty()) continue;
            with_images.push_back(name);
            if (is_camera_folder(name)) cameras.push_back(inside);
        }
        if (cameras.size() == 1) {
            list_.notes.push_back(fmt::format("{}: {} is read: the only camera in it", folder.string(),
                                              cameras.front().string()));
            return add_images(cameras.front(), look_into(cameras.front()));
        }
        const std::string none =
            fmt::format("{}: holds no image ({})", folder.string(), fmt::join(image_endings(), " "));
        if (cameras.size() > 1)
            throw InputError(fmt::format("{}: holds several cameras: {}: give the folder of one of them",
                                         folder.string(), some_of(with_images)));
        if (!with_images.empty())
            throw InputError(
                fmt::format("{}, but folders that do: {}: give those", none, some_of(with_images)));
        if (!found.videos.empty())
            throw InputError(fmt::format("{}, but videos: {}: give those", none, some_of(found.videos)));
        if (!found.others.empty()) throw InputError(fmt::format("{}, but: {}", none, some_of(found.others)));
        throw InputError(none);
    }

    NameTimes name_times_;
    ImageList list_;
    std::optional<std::size_t> given_by_name_;  ///< which series is of the images that are given by name
};

}  // namespace

FolderOfImages look_into(const fs::path& folder) {
    FolderOfImages found;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const fs::path& path = entry.path();
        const std::string name = path.filename().string();
        std::error_code error;
        const bool is_file = entry.is_regular_file(error) && !name.starts_with(".");
        if (entry.is_directory(error))
            found.folders.push_back(name);
        else if (is_file && is_named_as_video(path))
            found.videos.push_back(name);
        else if (is_file && (is_named_as_image(path) || vision::begins_as_an_image(path)))
            found.images.push_back(path);
        else
            found.others.push_back(name);
    }
    std::ranges::sort(found.images, by_natural_order);
    for (auto* names : {&found.videos, &found.folders, &found.others})
        std::ranges::sort(*names, natural_less);
    return found;
}

ImageList list_images(std::span<const fs::path> inputs, NameTimes name_times) {
    Lister lister(name_times);
    for (const fs::path& input : inputs) lister.add(input);
    return lister.end();
}

std::string title_of(const ImageSeries& series) {
    if (series.files_by_name < 2) return series.name;
    return fmt::format("{} and {} more given by name", series.name, series.files_by_name - 1);
}

}  // namespace fidservo
