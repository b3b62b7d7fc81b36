// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/images/image_frames.h"

#include "core/input_error.h"
#include "core/result.h"
#include "src/images/grey_range.h"
#include "vision/images/image_file.h"
#include "vision/images/media.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace fidservo {

namespace {

namespace fs = std::filesystem;

std::string name_in_video(const fs::path& video, std::size_t frame) {
    return fmt::format("{}#{}", video.string(), frame);
}

std::unique_ptr<vision::Video> opened(const fs::path& file) {
    auto video = vision::open_video(file);
    if (!video) throw InputError(video.error().text);
    return *std::move(video);
}

}  // namespace

class ImageFrames::OpenVideo {
  public:
    OpenVideo(fs::path file, std::size_t series)
        : file_(std::move(file)), series_(series), decoder_(opened(file_)) {}

    const vision::Video& decoder() const { return *decoder_; }
    void set_bits(int bits) { bits_ = bits; }

    std::optional<ImageFrame> next() {
        const auto picture = decoder_->next();
        if (!picture) return std::nullopt;
        ImageFrame frame;
        frame.name = name_in_video(file_, next_index_++);
        frame.series = series_;
        frame.time_ns = picture->time_ns;
        frame.file = file_;
        frame.bits = bits_ > 0 ? bits_ : vision::bits_of(picture->image);
        if (picture->damage.empty())
            frame.decoded = vision::to_8_bits(picture->image, frame.bits);
        else
            frame.damage = fmt::format("{}: {}", frame.name, picture->damage);
        return frame;
    }

    /// Decodes another copy of the video to its end.
    GreyLevels levels() const {
        GreyLevels levels;
        const auto again = opened(file_);
        while (const auto picture = again->next())
            if (picture->damage.empty()) levels.add(picture->image);
        return levels;
    }

  private:
    fs::path file_;
    std::size_t series_;
    std::unique_ptr<vision::Video> decoder_;
    int bits_ = 0;  ///< 0: each frame's own statement
    std::size_t next_index_ = 0;
};

ImageFrames::ImageFrames(const std::vector<fs::path>& inputs, const ImageOptions& options) {
    list_ = list_images(inputs, options.name_times);
    open_videos();
    size_ = std::accumulate(sizes_.begin(), sizes_.end(), std::size_t{0});
    for (const ImageSeries& series : list_.series)
        missing_.insert(missing_.end(), series.missing.begin(), series.missing.end());
    decide_ranges(options.one_range);
    is_one_timed_series_ = list_.series.size() == 1 && has_times(0);
}

ImageFrames::~ImageFrames() = default;

void ImageFrames::open_videos() {
    for (std::size_t k = 0; k < list_.series.size(); ++k) {
        const fs::path& file = list_.series[k].video;
        videos_.push_back(file.empty() ? nullptr : std::make_unique<OpenVideo>(file, k));
        sizes_.push_back(file.empty() ? list_.series[k].frames.size() : videos_.back()->decoder().packets());
        video_bits_.push_back(0);
        if (file.empty()) continue;
        for (const std::string& note : videos_.back()->decoder().notes())
            list_.notes.push_back(fmt::format("{}: {}", file.string(), note));
    }
}

void ImageFrames::decide_ranges(bool one_range) {
    std::vector<GreyLevels> levels;
    for (std::size_t k = 0; k < list_.series.size(); ++k) {
        const bool open_video = videos_[k] && videos_[k]->decoder().has_open_range();
        levels.push_back(open_video ? videos_[k]->levels() : levels_of(list_.series[k].deep));
    }
    GreyLevels all;
    if (one_range)
        for (const GreyLevels& one : levels) all.add(one);
    for (std::size_t k = 0; k < list_.series.size(); ++k) {
        if (levels[k].is_empty()) continue;
        const GreyLevels& decided = one_range ? all : levels[k];
        for (ImageFrame& frame : list_.series[k].frames) frame.bits = decided.bits();
        if (videos_[k]) {
            video_bits_[k] = decided.bits();
            videos_[k]->set_bits(decided.bits());
        }
        if (!one_range)
            list_.notes.push_back(fmt::format("{}: {}", title_of(list_.series[k]), decided.text()));
    }
    if (!all.is_empty()) list_.notes.push_back("all images: " + all.text());
}

bool ImageFrames::has_times(std::size_t series) const {
    if (videos_[series]) return videos_[series]->decoder().has_times();
    return std::ranges::all_of(list_.series[series].frames,
                               [](const ImageFrame& frame) { return frame.time_ns.has_value(); });
}

std::vector<ImageFrames::Series> ImageFrames::series() const {
    std::vector<Series> all;
    for (std::size_t k = 0; k < list_.series.size(); ++k)
        all.push_back({list_.series[k].name, sizes_[k], !list_.series[k].video.empty()});
    return all;
}

std::string ImageFrames::frame_name(std::size_t series, std::size_t frame) const {
    const ImageSeries& of = list_.series[series];
    return of.video.empty() ? of.frames[frame].name : name_in_video(of.video, frame);
}

void ImageFrames::pause() {
    for (auto& video : videos_) video.reset();
}

void ImageFrames::seek(std::size_t series, std::size_t frame) {
    pause();
    for (std::size_t k = series; k < list_.series.size(); ++k) {
        if (list_.series[k].video.empty()) continue;
        videos_[k] = std::make_unique<OpenVideo>(list_.series[k].video, k);
        videos_[k]->set_bits(video_bits_[k]);
    }
    current_series_ = series;
    current_frame_ = frame;
    for (std::size_t k = 0; videos_[series] && k < frame; ++k) videos_[series]->next();
}

std::optional<ImageFrame> ImageFrames::next() {
    for (; current_series_ < list_.series.size(); ++current_series_, current_frame_ = 0) {
        if (videos_[current_series_]) {
            if (auto frame = videos_[current_series_]->next()) return frame;
        } else if (const auto& frames = list_.series[current_series_].frames;
                   current_frame_ < frames.size()) {
            return frames[current_frame_++];
        }
    }
    return std::nullopt;
}

}  // namespace fidservo
