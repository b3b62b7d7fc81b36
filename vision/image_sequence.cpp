#include "vision/image_sequence.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <fstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

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

/// Any depth and any number of channels to 8-bit grey.
cv::Mat grey_of(const cv::Mat& image) {
    cv::Mat grey = image;
    if (image.channels() == 3) cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
    if (image.channels() == 4) cv::cvtColor(image, grey, cv::COLOR_BGRA2GRAY);
    if (grey.depth() == CV_16U) grey.convertTo(grey, CV_8U, 1.0 / 257.0);
    return grey;
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
    cv::Mat image;
    try {
        image = cv::imread(reference.file.string(), cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
    } catch (const cv::Exception&) {
        image.release();  // too large, or a broken header
    }
    if (image.empty())
        return failure(Reason::device,
                       fmt::format("{}: cannot be read as an image", reference.file.string()));
    return Frame{image, reference.time_ns, reference.time_ns, reference.sequence,
                 reference.file.filename().string()};
}

struct ImageSequence::Impl {
    std::vector<FrameReference> frames;
    std::size_t next = 0;
    std::unique_ptr<cv::VideoCapture> video;
    std::string video_name;
    double rate_hz = 0.0;
    std::size_t video_frames = 0;

    TimeNs time_of(std::size_t frame) const { return nanoseconds(static_cast<double>(frame) / rate_hz); }
};

ImageSequence::ImageSequence(const fs::path& input, double rate_hz) : impl_(std::make_unique<Impl>()) {
    FIDSERVO_DEMAND(rate_hz > 0);
    impl_->rate_hz = rate_hz;
    if (fs::is_regular_file(input) && is_video_file(input)) {
        impl_->video = std::make_unique<cv::VideoCapture>(input.string(), cv::CAP_FFMPEG);
        if (!impl_->video->isOpened())
            throw InputError(fmt::format("{}: cannot be read as a video", input.string()));
        impl_->video_name = input.filename().string();
        const double fps = impl_->video->get(cv::CAP_PROP_FPS);
        if (fps > 0) impl_->rate_hz = fps;
        impl_->video_frames =
            static_cast<std::size_t>(std::max(0.0, impl_->video->get(cv::CAP_PROP_FRAME_COUNT)));
        return;
    }
    impl_->frames = list_images(input);
    for (FrameReference& frame : impl_->frames)
        if (!frame.timed) frame.time_ns = impl_->time_of(frame.sequence);
}

ImageSequence::~ImageSequence() = default;

Result<std::optional<Frame>> ImageSequence::next() {
    if (impl_->video) {
        cv::Mat image;
        if (!impl_->video->read(image) || image.empty()) return std::optional<Frame>();
        const std::size_t number = impl_->next++;
        const TimeNs time_ns = impl_->time_of(number);
        return std::optional<Frame>({grey_of(image).clone(), time_ns, time_ns, number,
                                     fmt::format("{}#{}", impl_->video_name, number)});
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
    return impl_->video ? impl_->video_frames : impl_->frames.size();
}

}  // namespace fidservo::vision
