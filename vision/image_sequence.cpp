#include "vision/image_sequence.h"

#include "core/demand.h"
#include "core/input_error.h"
#include "vision/images/image_file.h"
#include "vision/images/media.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <fstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace fidservo::vision {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 9> image_extensions{".png", ".jpg", ".jpeg", ".pgm", ".ppm",
                                                           ".bmp", ".tif", ".tiff", ".webp"};
constexpr std::array<std::string_view, 6> video_extensions{".avi", ".mp4", ".mkv", ".mov", ".m4v", ".webm"};

template <std::size_t N>
bool has_extension(const fs::path& file, const std::array<std::string_view, N>& extensions) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blank = " \t\r";
    const auto first = text.find_first_not_of(blank);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// "#timestamp [ns],filename" and one line a frame.
std::vector<FrameReference> read_index(const fs::path& index) {
    std::ifstream lines(index);
    if (!lines) throw InputError(fmt::format("{}: cannot be read", index.string()));
    std::vector<FrameReference> frames;
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        const std::string_view text = trimmed(line);
        if (text.empty() || text.front() == '#') continue;
        const auto comma = text.find(',');
        const std::string_view time = trimmed(text.substr(0, comma));
        const std::string_view name = comma == std::string_view::npos ? "" : trimmed(text.substr(comma + 1));
        TimeNs time_ns = 0;
        const auto [end, error] = std::from_chars(time.data(), time.data() + time.size(), time_ns);
        if (error != std::errc() || end != time.data() + time.size() || name.empty())
            throw InputError(fmt::format("{}:{}: \"{}\" is not \"timestamp [ns],filename\"", index.string(),
                                         number, text));
        frames.push_back({index.parent_path() / "data" / name, time_ns, true, frames.size()});
    }
    if (frames.empty()) throw InputError(fmt::format("{}: names no image", index.string()));
    return frames;
}

std::vector<FrameReference> read_folder(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && is_image_file(entry.path())) files.push_back(entry.path());
    if (files.empty()) throw InputError(fmt::format("{}: the folder holds no image", folder.string()));
    std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
        return natural_less(a.filename().string(), b.filename().string());
    });
    std::vector<FrameReference> frames;
    frames.reserve(files.size());
    for (const fs::path& file : files) frames.push_back({file, 0, false, frames.size()});
    return frames;
}

}  // namespace

bool is_image_file(const fs::path& file) {
    return has_extension(file, image_extensions);
}
bool is_video_file(const fs::path& file) {
    return has_extension(file, video_extensions);
}

bool natural_less(const std::string& a, const std::string& b) {
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.size() && j < b.size()) {
        if (!digit(a[i]) || !digit(b[j])) {
            if (a[i] != b[j]) return a[i] < b[j];
            ++i;
            ++j;
            continue;
        }
        const auto number = [&](const std::string& text, std::size_t& at) {
            while (at < text.size() && text[at] == '0') ++at;
            const std::size_t begin = at;
            while (at < text.size() && digit(text[at])) ++at;
            return std::string_view(text).substr(begin, at - begin);
        };
        const std::string_view m = number(a, i);
        const std::string_view n = number(b, j);
        if (m.size() != n.size()) return m.size() < n.size();
        if (m != n) return m < n;
    }
    if (i < a.size() || j < b.size()) return i == a.size() && j < b.size();
    return a < b;  // they differ in leading zeros at most
}

std::vector<FrameReference> list_images(const fs::path& input) {
    std::error_code error;
    if (fs::is_directory(input, error)) {
        if (fs::exists(input / "data.csv")) return read_index(input / "data.csv");
        if (fs::exists(input / "cam0" / "data.csv")) return read_index(input / "cam0" / "data.csv");
        return read_folder(input);
    }
    if (!fs::exists(input, error))
        throw InputError(fmt::format("{}: no such file or folder", input.string()));
    return {{input, 0, false, 0}};
}

Result<Frame> load_frame(const FrameReference& reference) {
    Result<cv::Mat> image = read_grey(reference.file);
    if (!image) return tl::make_unexpected(image.error());
    return Frame{*std::move(image), reference.time_ns, reference.time_ns, reference.sequence,
                 reference.file.filename().string()};
}

struct ImageSequence::Impl {
    std::vector<FrameReference> frames;
    std::size_t next = 0;
    std::unique_ptr<Video> video;
    std::string video_name;
    double rate_hz = 0.0;

    TimeNs time_of(std::size_t frame) const { return nanoseconds(static_cast<double>(frame) / rate_hz); }
};

ImageSequence::ImageSequence(const fs::path& input, double rate_hz) : impl_(std::make_unique<Impl>()) {
    FIDSERVO_DEMAND(rate_hz > 0);
    impl_->rate_hz = rate_hz;
    if (fs::is_regular_file(input) && is_video_file(input)) {
        Result<std::unique_ptr<Video>> video = open_video(input);
        if (!video) throw InputError(video.error().text);
        impl_->video = *std::move(video);
        impl_->video_name = input.filename().string();
        if (const double stated_hz = impl_->video->rate_hz(); stated_hz > 0) impl_->rate_hz = stated_hz;
        return;
    }
    impl_->frames = list_images(input);
    for (FrameReference& frame : impl_->frames)
        if (!frame.timed) frame.time_ns = impl_->time_of(frame.sequence);
}

ImageSequence::~ImageSequence() = default;

Result<std::optional<Frame>> ImageSequence::next() {
    if (impl_->video) {
        const auto picture = impl_->video->next();
        if (!picture) return std::optional<Frame>();
        const std::size_t number = impl_->next++;
        const TimeNs time_ns = impl_->time_of(number);
        return std::optional<Frame>(
            {picture->grey, time_ns, time_ns, number, fmt::format("{}#{}", impl_->video_name, number)});
    }
    if (impl_->next == impl_->frames.size()) return std::optional<Frame>();
    Result<Frame> frame = load_frame(impl_->frames[impl_->next++]);
    if (!frame) return tl::make_unexpected(frame.error());
    return std::optional<Frame>(std::move(*frame));
}

Result<std::optional<Frame>> ImageSequence::poll(TimeNs /*now_ns*/) {
    return next();
}

std::size_t ImageSequence::size() const {
    return impl_->video ? impl_->video->stated_frames() : impl_->frames.size();
}

}  // namespace fidservo::vision
