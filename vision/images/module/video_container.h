// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A video's container, by FFmpeg's libavformat, and what all of its packets say together.
#include "core/result.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace fidservo::vision {

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

/// FFmpeg's words for an error.
std::string text_of_error(int error);

/// Whether no picture of a codec builds on another one.
bool stands_alone(AVCodecID id);

/// Whether frames of a codec may be stored in another order than that in which they are shown.
bool reorders_frames(AVCodecID id);

/// Fails with Reason::device: no video, without a decoder, or of a side beyond most_side_px.
Result<Container> open_container(const char* file);

/// The next packet of the stream into `packet`; what ended them, AVERROR_EOF or an error, if there is none.
int next_packet(const Container& container, AVPacket& packet);

/// Reads all packets to the end.
Survey survey(const Container& container, const char* file);

/// Why no frame has a time; empty if all have one.
std::string reason_for_no_times(const Container& container, const Survey& survey);

/// Notes for the user, as Video::notes() returns them.
std::vector<std::string> notes_of(const Container& container, const Survey& survey);

}  // namespace fidservo::vision
