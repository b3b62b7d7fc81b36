#include "src/replay/images.h"

#include "core/input_error.h"
#include "core/result.h"
#include "src/recording/reader.h"
#include "vision/images/image_file.h"
#include "vision/images/media.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fidservo {

namespace {

namespace fs = std::filesystem;

constexpr std::array image_endings{".png", ".jpg", ".jpeg", ".pgm", ".bmp", ".tif", ".tiff"};
constexpr std::array video_endings{".mp4", ".avi", ".mkv", ".mov", ".webm", ".mjpg", ".mjpeg"};

template <std::size_t n>
bool ends_with_one_of(const fs::path& file, const std::array<const char*, n>& endings) {
    std::string ending = file.extension();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

/// The folder that holds cam0 (an EuRoC data set keeps it in mav0); empty if the folder is no recording.
fs::path camera_root(const fs::path& folder) {
    for (const fs::path& root : {folder, folder / "mav0"})
        if (fs::exists(root / "cam0" / "data.csv")) return root;
    return {};
}

}  // namespace

struct ReplayFrames::Video {
    fs::path file;
    std::unique_ptr<vision::Video> decoder;
    std::size_t series;
    std::size_t next_index = 0;

    std::optional<ReplayFrame> next() {
        const auto picture = decoder->next();
        if (!picture) return std::nullopt;
        ReplayFrame frame;
        frame.name = fmt::format("{}#{}", file.string(), next_index++);
        frame.series = series;
        frame.time_ns = nanoseconds(picture->place_s);
        frame.decoded = picture->grey;
        return frame;
    }
};

ReplayFrames::ReplayFrames(const std::vector<fs::path>& inputs) {
    for (const fs::path& input : inputs) add(input);
}

ReplayFrames::~ReplayFrames() = default;

void ReplayFrames::add(const fs::path& input) {
    std::error_code error;
    if (!fs::exists(input, error))
        throw InputError(fmt::format("{}: there is no such file or folder", input.string()));
    if (!fs::is_directory(input)) {
        if (ends_with_one_of(input, video_endings)) return add_video(input);
        Series single;
        single.images.push_back({.name = input.string(), .series = series_.size(), .file = input});
        series_.push_back(std::move(single));
        ++size_;
        return;
    }
    if (!camera_root(input).empty()) return add_recording(input);
    if (fs::exists(input / "recording.yaml"))
        throw InputError(fmt::format("{}: the recording has no frames (cam0/data.csv)", input.string()));
    std::vector<fs::path> recordings;
    for (const auto& entry : fs::directory_iterator(input))
        if (entry.is_directory() && !camera_root(entry.path()).empty()) recordings.push_back(entry.path());
    std::sort(recordings.begin(), recordings.end());
    for (const fs::path& recording : recordings) add_recording(recording);
    if (recordings.empty()) add_image_folder(input);
}

void ReplayFrames::add_recording(const fs::path& folder) {
    const fs::path camera = camera_root(folder) / "cam0";
    Series recording;
    for (const FrameName& frame : read_frame_names(camera / "data.csv")) {
        const fs::path file = camera / "data" / frame.filename;
        recording.images.push_back({.name = file.string(),
                                    .series = series_.size(),
                                    .time_ns = frame.time_ns,
                                    .from_recording = true,
                                    .file = file});
    }
    if (recording.images.empty())
        throw InputError(fmt::format("{}: names no frame", (camera / "data.csv").string()));
    size_ += recording.images.size();
    series_.push_back(std::move(recording));
}

void ReplayFrames::add_image_folder(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && ends_with_one_of(entry.path(), image_endings))
            files.push_back(entry.path());
    if (files.empty())
        throw InputError(
            fmt::format("{}: holds no image ({})", folder.string(), fmt::join(image_endings, " ")));
    std::sort(files.begin(), files.end());
    Series images;
    for (const fs::path& file : files)
        images.images.push_back({.name = file.string(), .series = series_.size(), .file = file});
    size_ += images.images.size();
    series_.push_back(std::move(images));
}

void ReplayFrames::add_video(const fs::path& file) {
    auto video = std::make_unique<Video>();
    video->file = file;
    video->series = series_.size();
    auto decoder = vision::open_video(file);
    if (!decoder) throw InputError(decoder.error().text);
    video->decoder = *std::move(decoder);
    size_ += video->decoder->stated_frames();
    Series series;
    series.video = std::move(video);
    series_.push_back(std::move(series));
}

bool ReplayFrames::is_one_timed_series() const {
    if (series_.size() != 1) return false;
    return series_.front().video || series_.front().images.front().time_ns.has_value();
}

std::optional<ReplayFrame> ReplayFrames::next() {
    for (; current_series_ < series_.size(); ++current_series_, current_image_ = 0) {
        Series& series = series_[current_series_];
        if (series.video) {
            if (auto frame = series.video->next()) return frame;
        } else if (current_image_ < series.images.size()) {
            return series.images[current_image_++];
        }
    }
    return std::nullopt;
}

cv::Mat decode(const ReplayFrame& frame) {
    if (!frame.decoded.empty()) return frame.decoded;
    Result<cv::Mat> image = vision::read_grey(frame.file);
    if (!image) throw InputError(image.error().text);
    return *std::move(image);
}

}  // namespace fidservo
