// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/failure.h"
#include "vision/images/module/parts.h"
#include "vision/images/module/picture_samples.h"
#include "vision/images/module/stated_length.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/pixdesc.h>
}

namespace fidservo::vision {
namespace {

std::string text_of_error(int error) {
    char text[AV_ERROR_MAX_STRING_SIZE] = "";
    av_strerror(error, text, sizeof text);
    return text;
}

struct Closer {
    void operator()(AVFormatContext* format) const { avformat_close_input(&format); }
    void operator()(AVCodecContext* decoder) const { avcodec_free_context(&decoder); }
    void operator()(AVPacket* packet) const { av_packet_free(&packet); }
    void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
template <class T>
using Owned = std::unique_ptr<T, Closer>;

/// A file's container, and the stream of pictures in it.
struct Container {
    Owned<AVFormatContext> format;
    AVStream* stream = nullptr;
    const AVCodec* codec = nullptr;
    int width = 0, height = 0;  ///< of its pictures
};

std::vector<AVCodecParameters> parameters_of(const AVFormatContext& format) {
    std::vector<AVCodecParameters> parameters;
    for (unsigned k = 0; k < format.nb_streams; ++k) parameters.push_back(*format.streams[k]->codecpar);
    return parameters;
}

/// Does no picture of it build on another one?
bool stands_alone(AVCodecID id) {
    const AVCodecDescriptor* codec = avcodec_descriptor_get(id);
    return codec != nullptr && (codec->props & AV_CODEC_PROP_INTRA_ONLY) != 0;
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

/// The next packet of the stream into `packet`; what ended them, AVERROR_EOF or an error, if there is none.
int next_packet(const Container& container, AVPacket& packet) {
    while (true) {
        const int error = av_read_frame(container.format.get(), &packet);
        if (error < 0) return error;
        if (packet.stream_index == container.stream->index) return 0;
        av_packet_unref(&packet);
    }
}

/// What all packets of a stream say together.
struct Survey {
    std::size_t packets = 0;
    std::size_t hidden = 0;  ///< further ones, of which the container says that they are not shown
    std::size_t without_time = 0;
    bool times_rise = true;
    int end = AVERROR_EOF;          ///< what ended them
    std::uint64_t bytes_short = 0;  ///< of what the file says that it has
    bool lacks_end_mark = false;    ///< which its container puts at the end of a stream
};

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

std::string reason_for_no_times(const Container& container, const Survey& survey) {
    if (has_no_time_stamps(*container.format->iformat)) return "the stream has no time stamps";
    if (survey.without_time > 0)
        return fmt::format("{} of {} frames have no time stamp", survey.without_time, survey.packets);
    return survey.times_rise ? "" : "its time stamps do not rise from frame to frame";
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

class FfmpegVideo final : public Video {
  public:
    FfmpegVideo(Container container, Owned<AVCodecContext> decoder, const Survey& survey)
        : container_(std::move(container)),
          decoder_(std::move(decoder)),
          packets_(survey.packets),
          has_times_(reason_for_no_times(container_, survey).empty()),
          notes_(notes_of(container_, survey)),
          builds_on_others_(!stands_alone(decoder_->codec_id)) {}

    std::optional<Picture> next() override {
        while (true) {
            if (!holds_frame_) {
                const int error = avcodec_receive_frame(decoder_.get(), frame_.get());
                holds_frame_ = error == 0;
                if (error == AVERROR(EAGAIN)) {
                    feed();
                    continue;
                }
                if (error == AVERROR_EOF && refused_.empty()) return std::nullopt;
                if (error == AVERROR_EOF) return given_up(refused_.begin());
                if (error != 0) return Picture{.damage = text_of_error(error)};
            }
            const auto lost = std::ranges::find_if(
                refused_, [&](const RefusedPacket& packet) { return is_before_frame(packet); });
            if (lost != refused_.end()) return given_up(lost);
            holds_frame_ = false;
            if (given_up_.contains(number_of_frame())) continue;
            return picture();
        }
    }

    std::size_t packets() const override { return packets_; }
    bool has_times() const override { return has_times_; }
    bool has_open_range() const override {
        const auto* kind =
            av_pix_fmt_desc_get(static_cast<AVPixelFormat>(container_.stream->codecpar->format));
        return kind != nullptr && has_open_range_of(*kind, container_.stream->codecpar->bits_per_raw_sample);
    }
    std::vector<std::string> notes() const override { return notes_; }

  private:
    /// A packet that the decoder, or the container, says to be damaged, and whose frame has not come. Whether
    /// it still will depends on the decoder: many give out what they could make of it.
    struct RefusedPacket {
        std::int64_t number;
        std::int64_t pts;
        std::string why;
    };

    /// Gives the decoder the next packet, or the end.
    void feed() {
        if (next_packet(container_, *packet_) < 0) {
            avcodec_send_packet(decoder_.get(), nullptr);
            return;
        }
        decoder_->reordered_opaque = ++fed_;  // which the frame has, too
        std::string damage;
        if ((packet_->flags & AV_PKT_FLAG_CORRUPT) != 0) {
            damage = "its container says that it is damaged";
        } else if (const int error = avcodec_send_packet(decoder_.get(), packet_.get()); error < 0) {
            damage = text_of_error(error);
        }
        if (!damage.empty()) {
            note_damage_of(fed_);
            if ((packet_->flags & AV_PKT_FLAG_DISCARD) == 0)
                refused_.push_back({fed_, packet_->pts, std::move(damage)});
        }
        av_packet_unref(packet_.get());
    }

    /// Of the packet that the frame was decoded from; of a decoder that does not tell, the last one.
    std::int64_t number_of_frame() const {
        return frame_->reordered_opaque > 0 ? frame_->reordered_opaque : fed_;
    }

    /// Is the packet's frame one that was to be shown before the frame that is held?
    bool is_before_frame(const RefusedPacket& packet) const {
        if (packet.number == number_of_frame()) return false;
        if (packet.pts != AV_NOPTS_VALUE && frame_->pts != AV_NOPTS_VALUE) return packet.pts < frame_->pts;
        return packet.number < number_of_frame();
    }

    /// The frame of a packet that has none; should it come later, it has been counted.
    Picture given_up(std::deque<RefusedPacket>::iterator packet) {
        given_up_.insert(packet->number);
        Picture lost{.damage = std::move(packet->why)};
        refused_.erase(packet);
        return lost;
    }

    void note_damage_of(std::int64_t packet) {
        if (builds_on_others_) damaged_from_ = std::min(damaged_from_, packet);
    }

    Picture damaged(std::string why) {
        note_damage_of(number_of_frame());
        return {.damage = std::move(why)};
    }

    std::optional<Picture> picture() {
        const std::int64_t number = number_of_frame();
        const auto refused = std::ranges::find(refused_, number, &RefusedPacket::number);
        if (refused != refused_.end()) return given_up(refused);
        if (frame_->decode_error_flags != 0 || (frame_->flags & AV_FRAME_FLAG_CORRUPT) != 0)
            return damaged("its data are damaged");
        if (frame_->width != container_.width || frame_->height != container_.height)
            return damaged(fmt::format("{} x {} px where the stream has {} x {} px", frame_->width,
                                       frame_->height, container_.width, container_.height));
        if (frame_->key_frame != 0 && number > damaged_from_) damaged_from_ = undamaged;
        if (number > damaged_from_) return Picture{.damage = "it builds on a damaged frame"};
        Picture picture;
        if (has_times_) {
            if (frame_->pts == AV_NOPTS_VALUE || frame_->pts <= last_pts_)
                return Picture{.damage = "its time is not after that of the frame before"};
            last_pts_ = frame_->pts;
            picture.time_ns =
                av_rescale_q(frame_->pts, container_.stream->time_base, {1, static_cast<int>(ns_per_s)});
        }
        auto image = grey_samples(*frame_, container_.stream->codecpar->bits_per_raw_sample);
        if (!image) return damaged(image.error().text);
        picture.image = *std::move(image);
        return picture;
    }

    Container container_;
    Owned<AVCodecContext> decoder_;
    std::size_t packets_;
    bool has_times_;
    std::vector<std::string> notes_;
    bool builds_on_others_;
    static constexpr std::int64_t undamaged = std::numeric_limits<std::int64_t>::max();
    std::int64_t damaged_from_ = undamaged;  ///< frames of later packets build on one that is damaged
    std::int64_t fed_ = 0;                   ///< packets, in the order of the stream
    std::deque<RefusedPacket> refused_;
    std::set<std::int64_t> given_up_;  ///< packets whose frames were counted without having come
    bool holds_frame_ = false;
    std::int64_t last_pts_ = std::numeric_limits<std::int64_t>::min();
    Owned<AVPacket> packet_{av_packet_alloc()};
    Owned<AVFrame> frame_{av_frame_alloc()};
};

}  // namespace

Result<std::unique_ptr<Video>> ffmpeg_video(const char* file) {
    av_log_set_level(AV_LOG_QUIET);
    auto surveyed = open_container(file);
    if (!surveyed) return tl::make_unexpected(surveyed.error());
    const Survey what = survey(*surveyed, file);
    if (what.packets == 0) return failure(Reason::device, "it holds no frame");
    auto container = open_container(file);  // not all containers can be wound back
    if (!container) return tl::make_unexpected(container.error());
    Owned<AVCodecContext> decoder(avcodec_alloc_context3(container->codec));
    avcodec_parameters_to_context(decoder.get(), container->stream->codecpar);
    decoder->pkt_timebase = container->stream->time_base;
    decoder->err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER | AV_EF_EXPLODE;
    decoder->flags |= AV_CODEC_FLAG_OUTPUT_CORRUPT;  // or they would be missing without a word
    decoder->max_pixels = static_cast<std::int64_t>(most_pixels);
    if (const int error = avcodec_open2(decoder.get(), container->codec, nullptr); error < 0)
        return failure(Reason::device, text_of_error(error));
    return std::unique_ptr<Video>(
        std::make_unique<FfmpegVideo>(*std::move(container), std::move(decoder), what));
}

}  // namespace fidservo::vision
