// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/images/film.h"

#include <array>
#include <cstring>
#include <stdexcept>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
}

namespace fidservo::testing {
namespace {

void must(int result, const char* what) {
    if (result < 0) throw std::runtime_error(std::string("film: ") + what);
}

AVPixelFormat pixels_of(const Film& film) {
    if (film.codec == "mjpeg") return AV_PIX_FMT_YUVJ420P;
    if (film.codec == "mpeg4" || film.codec == "libx264" || film.codec == "libtheora")
        return AV_PIX_FMT_YUV420P;
    return film.frames.front().depth() == CV_16U ? AV_PIX_FMT_GRAY16LE : AV_PIX_FMT_GRAY8;
}

/// 0 to 255 as television's 16 to 235.
cv::Mat limited(const cv::Mat& grey) {
    cv::Mat luma;
    grey.convertTo(luma, CV_8U, 219.0 / 255.0, 16.0);
    return luma;
}

void fill(AVFrame& frame, const cv::Mat& grey) {
    for (int row = 0; row < grey.rows; ++row)
        std::memcpy(frame.data[0] + static_cast<std::ptrdiff_t>(row) * frame.linesize[0], grey.ptr(row),
                    static_cast<std::size_t>(grey.cols) * grey.elemSize());
    for (const int plane : {1, 2})
        if (frame.data[plane] != nullptr)
            for (int row = 0; row < grey.rows / 2; ++row)
                std::memset(frame.data[plane] + static_cast<std::ptrdiff_t>(row) * frame.linesize[plane], 128,
                            static_cast<std::size_t>(grey.cols) / 2);
}

class Writer {
  public:
    Writer(const std::filesystem::path& file, const Film& film) {
        av_log_set_level(AV_LOG_QUIET);
        const char* container = film.container.empty() ? nullptr : film.container.c_str();
        must(avformat_alloc_output_context2(&format_, nullptr, container, file.c_str()), "container");
        const AVCodec* codec = avcodec_find_encoder_by_name(film.codec.c_str());
        if (codec == nullptr) throw std::runtime_error("film: codec");
        encoder_ = avcodec_alloc_context3(codec);
        encoder_->width = film.frames.front().cols;
        encoder_->height = film.frames.front().rows;
        encoder_->pix_fmt = pixels_of(film);
        encoder_->time_base = {film.unit_ms, 1000};
        encoder_->framerate = {1000, film.unit_ms};
        encoder_->global_quality = FF_QP2LAMBDA;
        if (film.codec != "libx264") encoder_->flags |= AV_CODEC_FLAG_QSCALE;
        if ((format_->oformat->flags & AVFMT_GLOBALHEADER) != 0)
            encoder_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
        encoder_->max_b_frames = film.codec == "libx264" ? 3 : film.frames_between;
        encoder_->sample_aspect_ratio = {film.pixel_width, film.pixel_height};
        must(avcodec_open2(encoder_, codec, nullptr), "encoder");
        stream_ = avformat_new_stream(format_, nullptr);
        must(avcodec_parameters_from_context(stream_->codecpar, encoder_), "stream");
        stream_->time_base = encoder_->time_base;
        stream_->avg_frame_rate = encoder_->framerate;
        stream_->sample_aspect_ratio = encoder_->sample_aspect_ratio;
        if (film.is_turned) turn();
        must(avio_open(&format_->pb, file.c_str(), AVIO_FLAG_WRITE), "file");
        must(avformat_write_header(format_, nullptr), "header");
    }
    ~Writer() {
        avcodec_free_context(&encoder_);
        if (format_->pb != nullptr) avio_closep(&format_->pb);
        avformat_free_context(format_);
        av_packet_free(&packet_);
    }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    void write(const AVFrame* frame) {
        must(avcodec_send_frame(encoder_, frame), "frame");
        while (avcodec_receive_packet(encoder_, packet_) >= 0) {
            av_packet_rescale_ts(packet_, encoder_->time_base, stream_->time_base);
            packet_->stream_index = 0;
            must(av_write_frame(format_, packet_), "packet");
            av_packet_unref(packet_);
        }
    }
    void end() {
        write(nullptr);
        must(av_write_trailer(format_), "trailer");
    }
    const AVCodecContext& encoder() const { return *encoder_; }

  private:
    void turn() {
        constexpr std::size_t bytes = 9 * sizeof(std::int32_t);
        auto* matrix = av_stream_new_side_data(stream_, AV_PKT_DATA_DISPLAYMATRIX, bytes);
        av_display_rotation_set(reinterpret_cast<std::int32_t*>(matrix), 90.0);
    }

    AVFormatContext* format_ = nullptr;
    AVCodecContext* encoder_ = nullptr;
    AVStream* stream_ = nullptr;
    AVPacket* packet_ = av_packet_alloc();
};

}  // namespace

void write_film(const std::filesystem::path& file, const Film& film) {
    Writer writer(file, film);
    AVFrame* frame = av_frame_alloc();
    frame->format = writer.encoder().pix_fmt;
    frame->width = writer.encoder().width;
    frame->height = writer.encoder().height;
    must(av_frame_get_buffer(frame, 0), "memory");
    for (std::size_t k = 0; k < film.frames.size(); ++k) {
        must(av_frame_make_writable(frame), "memory");
        fill(*frame,
             writer.encoder().pix_fmt == AV_PIX_FMT_YUV420P ? limited(film.frames[k]) : film.frames[k]);
        frame->pts = film.times[k];
        frame->quality = FF_QP2LAMBDA;
        writer.write(frame);
    }
    av_frame_free(&frame);
    writer.end();
}

}  // namespace fidservo::testing
