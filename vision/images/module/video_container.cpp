// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/images/module/video_container.h"

#include "core/failure.h"
#include "vision/images/image_file.h"
#include "vision/images/module/stated_length.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>

extern "C" {
#include <libavutil/display.h>
}

namespace fidservo::vision {
namespace {

std::vector<AVCodecParameters> parameters_of(const AVFormatContext& format) {
    std::vector<AVCodecParameters> parameters;
    for (unsigned k = 0; k < format.nb_streams; ++k) parameters.push_back(*format.streams[k]->codecpar);
    return parameters;
}

/// Do times rise in the order in which frames are shown? Of H.264 and H.265 a frame may be stored up to 16
/// frames after one that is shown later, and no two have one time.
class RisingTimes {
  public:
    void add(std::int64_t time) {
        constexpr std::size_t most_reordered = 16;
        if (std::ranges::find(last_, time) != last_.end() || time <= before_) rise_ = false;
        last_.push_back(time);
        if (last_.size() <= most_reordered) return;
        before_ = std::max(before_, last_.front());
        last_.pop_front();
    }
    bool rise() const { return rise_; }

  private:
    std::deque<std::int64_t> last_;
    std::int64_t before_ = std::numeric_limits<std::int64_t>::min();  ///< the latest of those before `last_`
    bool rise_ = true;
};

bool is_turned(AVStream& stream) {
    const auto* matrix = reinterpret_cast<const std::int32_t*>(
        av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr));
    if (matrix == nullptr) return false;
    return matrix[0] <= 0 || matrix[1] != 0 || matrix[3] != 0 || matrix[4] <= 0;
}

/// Raw streams, and pictures one behind the other: FFmpeg counts time there by a rate that nobody stated.
bool has_no_time_stamps(const AVInputFormat& kind) {
    const std::string_view name(kind.name);
    return (kind.flags & AVFMT_NOTIMESTAMPS) != 0 || name.ends_with("_pipe") || name.starts_with("image2");
}

/// What the end of the file and its header say of frames that are missing; empty if nothing does. Only what
/// was compared is said: fewer frames than a header counts are no proof that the file was cut.
std::string missing_frames(const Container& container, const Survey& survey) {
    const std::size_t held = survey.packets + survey.hidden;
    const auto stated = static_cast<std::size_t>(std::max<std::int64_t>(0, container.stream->nb_frames));
    const std::string counted = stated > held ? fmt::format(" of {}", stated) : "";
    if (survey.bytes_short > 0)
        return fmt::format("it is cut short after {}{} frames: {} bytes are missing", held, counted,
                           survey.bytes_short);
    if (survey.end != AVERROR_EOF)
        return fmt::format("nothing can be read after {}{} frames: {}", held, counted,
                           text_of_error(survey.end));
    if (survey.lacks_end_mark)
        return fmt::format(
            "its last page is not marked as the end of a stream: frames may be missing after {}", held);
    return counted.empty() ? "" : fmt::format("it holds {} frames where its header says {}", held, stated);
}

/// That pixels are not square; empty if they are, or if nothing says.
std::string shape_of_pixels(const Container& container) {
    const AVRational aspect = av_guess_sample_aspect_ratio(container.format.get(), container.stream, nullptr);
    if (aspect.num <= 0 || aspect.den <= 0 || aspect.num == aspect.den) return {};
    return fmt::format(
        "its pixels are stated to be {}:{} in width and height; here they count as square, so that "
        "um to the right and um down are of different lengths",
        aspect.num, aspect.den);
}

}  // namespace

std::string text_of_error(int error) {
    char text[AV_ERROR_MAX_STRING_SIZE] = "";
    av_strerror(error, text, sizeof text);
    return text;
}

bool stands_alone(AVCodecID id) {
    const AVCodecDescriptor* codec = avcodec_descriptor_get(id);
    return codec != nullptr && (codec->props & AV_CODEC_PROP_INTRA_ONLY) != 0;
}

bool reorders_frames(AVCodecID id) {
    const AVCodecDescriptor* codec = avcodec_descriptor_get(id);
    return codec != nullptr && (codec->props & AV_CODEC_PROP_REORDER) != 0;
}

Result<Container> open_container(const char* file) {
    AVDictionary* options = nullptr;
    av_dict_set(&options, "protocol_whitelist", "file", 0);  // a play list must not reach the network
    AVFormatContext* opened = nullptr;
    const int error = avformat_open_input(&opened, fmt::format("file:{}", file).c_str(), nullptr, &options);
    av_dict_free(&options);
    if (error < 0) return failure(Reason::device, text_of_error(error));
    Container container;
    container.format.reset(opened);
    const std::vector<AVCodecParameters> before = parameters_of(*opened);
    if (const int unknown = avformat_find_stream_info(opened, nullptr); unknown < 0)
        return failure(Reason::device, text_of_error(unknown));
    const int best = av_find_best_stream(opened, AVMEDIA_TYPE_VIDEO, -1, -1, &container.codec, 0);
    if (best == AVERROR_STREAM_NOT_FOUND) return failure(Reason::device, "it holds no stream of pictures");
    if (best < 0) return failure(Reason::device, "there is no decoder for its stream of pictures");
    container.stream = opened->streams[best];
    const AVCodecParameters& stated = *container.stream->codecpar;
    container.width = stated.width;
    container.height = stated.height;
    const auto number = static_cast<std::size_t>(best);
    if (number < before.size() && stands_alone(stated.codec_id) && before[number].width > 0) {
        container.width = before[number].width;  // FFmpeg puts a frame's own in place of what the file states
        container.height = before[number].height;
    }
    if (const Status readable = demand_readable_size(static_cast<std::uint64_t>(stated.width),
                                                     static_cast<std::uint64_t>(stated.height));
        !readable)
        return tl::make_unexpected(readable.error());
    for (unsigned k = 0; k < opened->nb_streams; ++k)
        if (static_cast<int>(k) != best) opened->streams[k]->discard = AVDISCARD_ALL;
    return container;
}

int next_packet(const Container& container, AVPacket& packet) {
    while (true) {
        const int error = av_read_frame(container.format.get(), &packet);
        if (error < 0) return error;
        if (packet.stream_index == container.stream->index) return 0;
        av_packet_unref(&packet);
    }
}

Survey survey(const Container& container, const char* file) {
    Survey survey;
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    const StatedEnd stated = stated_end(file);
    if (!error && stated.bytes > bytes) survey.bytes_short = stated.bytes - bytes;
    survey.lacks_end_mark = stated.lacks_mark;
    RisingTimes times;
    const Owned<AVPacket> packet(av_packet_alloc());
    while ((survey.end = next_packet(container, *packet)) == 0) {
        if ((packet->flags & AV_PKT_FLAG_DISCARD) != 0) {
            ++survey.hidden;
        } else {
            ++survey.packets;
            if (packet->pts == AV_NOPTS_VALUE)
                ++survey.without_time;
            else
                times.add(packet->pts);
        }
        av_packet_unref(packet.get());
    }
    survey.times_rise = times.rise();
    return survey;
}

std::string reason_for_no_times(const Container& container, const Survey& survey) {
    if (has_no_time_stamps(*container.format->iformat)) return "the stream has no time stamps";
    if (survey.without_time > 0)
        return fmt::format("{} of {} frames have no time stamp", survey.without_time, survey.packets);
    return survey.times_rise ? "" : "its time stamps do not rise from frame to frame";
}

std::vector<std::string> notes_of(const Container& container, const Survey& survey) {
    std::vector<std::string> notes;
    unsigned streams = 0;
    for (unsigned k = 0; k < container.format->nb_streams; ++k)
        if (container.format->streams[k]->codecpar->codec_type == AVMEDIA_TYPE_VIDEO) ++streams;
    if (streams > 1)
        notes.push_back(
            fmt::format("stream {} of its {} streams of pictures is read", container.stream->index, streams));
    if (const std::string why = reason_for_no_times(container, survey); !why.empty())
        notes.push_back(fmt::format("no times are taken: {}", why));
    if (is_turned(*container.stream))
        notes.emplace_back("players turn its picture; here pixels are where the stream has them");
    if (survey.hidden > 0)
        notes.push_back(
            fmt::format("passed over: {} of its {} frames, which its container marks as not shown",
                        survey.hidden, survey.packets + survey.hidden));
    for (std::string note : {shape_of_pixels(container), missing_frames(container, survey)})
        if (!note.empty()) notes.push_back(std::move(note));
    return notes;
}

}  // namespace fidservo::vision
