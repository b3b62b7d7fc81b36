// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/failure.h"
#include "vision/images/module/parts.h"
#include "vision/images/module/picture_samples.h"
#include "vision/images/module/video_container.h"

#include <algorithm>
#include <deque>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

extern "C" {
#include <libavutil/pixdesc.h>
}

namespace fidservo::vision {
namespace {

class FfmpegVideo final : public Video {
  public:
    FfmpegVideo(Container container, Owned<AVCodecContext> decoder, const Survey& survey)
        : container_(std::move(container)),
          decoder_(std::move(decoder)),
          packets_(survey.packets),
          has_times_(reason_for_no_times(container_, survey).empty()),
          notes_(notes_of(container_, survey)),
          builds_on_others_(!stands_alone(decoder_->codec_id)),
          reorders_(reorders_frames(decoder_->codec_id)) {}

    std::optional<Picture> next() override {
        auto picture = next_in_order();
        if (picture) ++given_;
        return picture;
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
    std::optional<Picture> next_in_order() {
        while (true) {
            if (!holds_frame_) {
                const int error = avcodec_receive_frame(decoder_.get(), frame_.get());
                holds_frame_ = error == 0;
                if (error == AVERROR(EAGAIN)) {
                    feed();
                    continue;
                }
                if (error == AVERROR_EOF) return frame_that_never_came();
                if (error != 0) return Picture{.damage = text_of_error(error)};
                if (!has_damage_ && !at_end_) note_delay();
            }
            if (auto lost = frame_lost_before(); lost) return lost;
            holds_frame_ = false;
            if (given_up_.contains(number_of_frame())) continue;
            return picture();
        }
    }

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
            at_end_ = true;
            return;
        }
        decoder_->reordered_opaque = ++fed_;  // which the frame has, too
        const bool is_shown = (packet_->flags & AV_PKT_FLAG_DISCARD) == 0;
        if (is_shown) ++shown_;
        std::string damage;
        if ((packet_->flags & AV_PKT_FLAG_CORRUPT) != 0) {
            damage = "its container says that it is damaged";
        } else if (const int error = avcodec_send_packet(decoder_.get(), packet_.get()); error < 0) {
            damage = text_of_error(error);
        }
        if (!damage.empty()) {
            note_damage_of(fed_);
            if (is_shown) refused_.push_back({fed_, packet_->pts, std::move(damage)});
        }
        av_packet_unref(packet_.get());
    }

    /// Of the packet that the frame was decoded from; of a decoder that does not tell, the last one.
    std::int64_t number_of_frame() const {
        return frame_->reordered_opaque > 0 ? frame_->reordered_opaque : fed_;
    }

    /// Notes by how many packets a frame comes later than its place, as long as nothing is damaged.
    void note_delay() {
        const std::size_t delay = shown_ - given_;
        steady_for_ = delay == delay_ ? steady_for_ + 1 : 0;
        delay_ = delay;
    }

    /// Does the decoder give a frame for each packet, always as many packets later? Not where a packet is
    /// half a frame or, of a codec that reorders none, one that is never shown.
    bool is_steady() const {
        constexpr std::size_t enough = 2;
        return reorders_ && steady_for_ >= enough;
    }

    /// A frame that was to be shown before the one that is held and did not come: near damage decoders leave
    /// out frames without a word, which the places of those behind them show.
    std::optional<Picture> frame_lost_before() {
        if (is_steady()) {
            if (!has_damage_ || at_end_ || given_ + delay_ >= shown_) return std::nullopt;
            return refused_.empty() ? without_frame() : given_up(refused_.begin());
        }
        const auto lost = std::ranges::find_if(
            refused_, [&](const RefusedPacket& packet) { return is_before_frame(packet); });
        if (lost == refused_.end()) return std::nullopt;
        return given_up(lost);
    }

    /// After the last frame.
    std::optional<Picture> frame_that_never_came() {
        if (!is_steady()) {
            if (refused_.empty()) return std::nullopt;
            return given_up(refused_.begin());
        }
        if (!has_damage_ || given_ >= packets_) return std::nullopt;
        return refused_.empty() ? without_frame() : given_up(refused_.begin());
    }

    static Picture without_frame() { return {.damage = "the decoder leaves it out, after a damaged frame"}; }

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
        has_damage_ = true;
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
    bool builds_on_others_, reorders_;
    static constexpr std::int64_t undamaged = std::numeric_limits<std::int64_t>::max();
    std::int64_t damaged_from_ = undamaged;  ///< frames of later packets build on one that is damaged
    std::int64_t fed_ = 0;                   ///< packets, in the order of the stream
    std::deque<RefusedPacket> refused_;
    std::set<std::int64_t> given_up_;  ///< packets whose frames were counted without having come
    bool holds_frame_ = false;
    bool has_damage_ = false;
    bool at_end_ = false;                     ///< all packets are fed
    std::size_t shown_ = 0;                   ///< packets that were fed and are to be shown
    std::size_t given_ = 0;                   ///< pictures that next() has returned
    std::size_t delay_ = 0, steady_for_ = 0;  ///< packets; frames
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
