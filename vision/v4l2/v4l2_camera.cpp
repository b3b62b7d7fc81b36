// SPDX-License-Identifier: GPL-3.0-or-later
#include "vision/v4l2/v4l2_camera.h"

#include "core/demand.h"
#include "core/failure.h"
#include "core/input_error.h"
#include "core/monotonic_clock.h"
#include "core/wake_signal.h"
#include "vision/v4l2/camera_list.h"
#include "vision/v4l2/frame_slot.h"
#include "vision/v4l2/grey_image.h"
#include "vision/v4l2/leased_image.h"
#include "vision/v4l2/sequence.h"
#include "vision/v4l2/stream.h"

#include <cmath>
#include <stop_token>
#include <thread>

#include <fmt/format.h>

namespace fidservo::vision::v4l2 {

namespace {

/// Below that, a frame that is kept would leave the driver without room for the next.
constexpr std::size_t least_with_driver = 2;

std::vector<std::string> notes_on(const FrameStream& stream, const CaptureSettings& settings) {
    std::vector<std::string> notes{fmt::format("{}: {}, {} memory", stream.card(), text_of(stream.format()),
                                               stream.memory() == Memory::mapped ? "the driver's" : "own")};
    for (const LockedControl& control : stream.lock().locked)
        notes.push_back(fmt::format("\"{}\" fixed at {}", control.name, control.value));
    if (!stream.lock().exposure_s)
        notes.push_back(fmt::format("no exposure control: frames are timed as if exposed for {:.6g} s",
                                    settings.exposure_s));
    if (std::abs(stream.frame_rate_hz() / settings.frame_rate_hz - 1.0) > 0.01)
        notes.push_back(fmt::format("{:.6g} frames/s in place of {:.6g}", stream.frame_rate_hz(),
                                    settings.frame_rate_hz));
    if (!stream.leased_frames_stay())
        notes.push_back("its driver writes into frames that are still looked at: they are copied");
    return notes;
}

}  // namespace

struct V4l2Camera::Impl {
    Impl(const std::filesystem::path& node, const CaptureSettings& wanted)
        : settings(wanted),
          stream(std::make_unique<FrameStream>(node, wanted)),
          card(stream->card()),
          leased_frames_stay(stream->leased_frames_stay()),
          notes(notes_on(*stream, wanted)),
          timeout_ns(ns_per_s + nanoseconds(5.0 / wanted.frame_rate_hz)) {
        const auto by_id = by_id_of(node);
        path = by_id.empty() ? node : by_id;
        reader = std::jthread([this](const std::stop_token& stop) { read(stop); });
    }

    /// The reading thread: until it is told to end, or the camera is lost for good.
    void read(const std::stop_token& stop) {
        const std::stop_callback wake_on_stop(stop, [this] { wake.raise(); });
        while (!stop.stop_requested()) {
            const Failure why = read_until_failure(stop);
            if (stop.stop_requested()) return;
            stream.reset();
            if (reconnect(stop, why)) continue;
            if (!stop.stop_requested()) slot.fail(why);
            return;
        }
    }

    /// Also returns when it is told to end.
    Failure read_until_failure(const std::stop_token& stop) {
        last_whole_ns = monotonic_now_ns();
        while (!stop.stop_requested()) {
            const TimeNs left_ns = last_whole_ns + timeout_ns - monotonic_now_ns();
            const auto woken = stream->wait(wake.fd(), left_ns);
            if (!woken) return woken.error();
            const auto taken = *woken == Wake::late ? Result<int>(0) : take_all();
            if (!taken) return taken.error();
            if (*woken == Wake::broken && *taken == 0)
                return {Reason::device, fmt::format("{}: the stream broke off", path.string())};
            if (monotonic_now_ns() - last_whole_ns > timeout_ns) return too_late();
        }
        return {Reason::stopped, ""};
    }

    Failure too_late() const {
        if (const auto same = stream->check_format(); !same) return same.error();
        return {Reason::timeout, fmt::format("{}: no whole frame for {:.1f} s ({} damaged)", path.string(),
                                             seconds(timeout_ns), slot.counts().damaged)};
    }

    /// Everything that the driver has; the newest is left in the slot. @return how many frames there were
    Result<int> take_all() {
        for (int taken = 0;; ++taken) {
            auto lease = stream->take();
            if (!lease) return tl::make_unexpected(lease.error());
            if (!*lease) return taken;
            if (auto kept = keep(std::move(**lease)); !kept) return tl::make_unexpected(kept.error());
        }
    }

    Status keep(Lease lease) {
        const TimeNs arrival_ns = monotonic_now_ns();
        const FilledBuffer& filled = lease.filled();
        FrameCounts more{.lost = sequence.take(filled.sequence)};
        const bool whole = !filled.damaged && is_whole(stream->format(), filled.used_bytes);
        if (!whole) more.damaged = 1;
        if (!stamp_is_usable(filled.stamp, arrival_ns)) more.unstamped = 1;
        slot.count(more);
        if (!whole) return filled.damaged ? Status() : stream->check_format();
        last_whole_ns = arrival_ns;
        const FrameDelays delays{stream->lock().exposure_s.value_or(settings.exposure_s), settings.latency_s};
        const TimeNs time_ns = mid_exposure_ns(filled.stamp, arrival_ns, delays);
        slot.put({std::move(lease), stream->format(), time_ns, arrival_ns, sequence.sequence()});
        return {};
    }

    /// Waits for the camera to come back. @return is it back?
    bool reconnect(const std::stop_token& stop, const Failure& why) {
        constexpr TimeNs between_ns = 100 * ns_per_ms;
        slot.clear();
        const TimeNs end_ns = monotonic_now_ns() + nanoseconds(settings.reconnect_s);
        std::string trouble;
        while (!stop.stop_requested() && monotonic_now_ns() < end_ns) {
            wake.wait(between_ns);
            try {
                auto again = std::make_unique<FrameStream>(std::filesystem::canonical(path), settings);
                if (again->card() != card)
                    throw RunFault(fmt::format("{}: another camera, {}", path.string(), again->card()));
                stream = std::move(again);
                sequence.restart();
                slot.count({.reconnects = 1});
                return true;
            } catch (const std::runtime_error& error) {
                trouble = error.what();
            }
        }
        if (settings.reconnect_s > 0.0)
            slot.fail({why.reason, fmt::format("{}; not back after {:.6g} s: {}", why.text,
                                               settings.reconnect_s, trouble)});
        return false;
    }

    /// A frame that turned out to be damaged when it was decoded.
    Result<std::optional<Frame>> damaged(const RawFrame& raw, const Failure& why) {
        slot.count({.damaged = 1});
        if (raw.arrival_ns - last_decoded_ns > timeout_ns) {
            slot.fail({Reason::timeout, fmt::format("{}: no frame can be decoded for {:.1f} s: {}",
                                                    path.string(), seconds(timeout_ns), why.text)});
        }
        return std::optional<Frame>();
    }

    Result<std::optional<Frame>> handed_out(RawFrame raw) {
        if (last_decoded_ns == 0) last_decoded_ns = raw.arrival_ns;
        auto image = grey_image(raw.format, raw.lease.bytes(), jpeg);
        if (!image) return damaged(raw, image.error());
        if (image->cols != raw.format.width_px || image->rows != raw.format.height_px) {
            slot.fail(
                {Reason::device, fmt::format("{}: the format changed under way, from {} to {} x {} px",
                                             path.string(), text_of(raw.format), image->cols, image->rows)});
            return slot_failure();
        }
        last_decoded_ns = raw.arrival_ns;
        Frame frame;
        frame.time_ns = raw.time_ns;
        frame.arrival_ns = raw.arrival_ns;
        frame.sequence = raw.sequence;
        if (raw.format.pixels != PixelFormat::grey)
            frame.image = *image;
        else if (!leased_frames_stay || raw.lease.queue().with_driver() < least_with_driver)
            frame.image = image->clone();
        else
            frame.image = leased_image(std::move(raw.lease), *image);
        slot.count({.handed_out = 1});
        return std::optional<Frame>(std::move(frame));
    }

    Result<std::optional<Frame>> slot_failure() {
        const auto failed = slot.take(0);
        FIDSERVO_DEMAND(!failed);
        return tl::make_unexpected(failed.error());
    }

    CaptureSettings settings;
    std::unique_ptr<FrameStream> stream;  ///< the reading thread's once that runs
    std::string card;
    bool leased_frames_stay;
    std::vector<std::string> notes;
    TimeNs timeout_ns;
    std::filesystem::path path;  ///< under which the camera comes back
    TimeNs last_whole_ns = 0;
    SequenceCounter sequence;
    FrameSlot slot;
    WakeSignal wake;
    JpegDecoder jpeg;  ///< the asking thread's, as is what follows
    TimeNs last_decoded_ns = 0;
    std::jthread reader;
};

V4l2Camera::V4l2Camera(const std::filesystem::path& node, const CaptureSettings& settings)
    : impl_(std::make_unique<Impl>(node, settings)) {}

V4l2Camera::~V4l2Camera() = default;

Result<std::optional<Frame>> V4l2Camera::poll(TimeNs now_ns) {
    auto raw = impl_->slot.take(now_ns);
    if (!raw) return tl::make_unexpected(raw.error());
    if (!*raw) return std::optional<Frame>();
    return impl_->handed_out(std::move(**raw));
}

FrameCounts V4l2Camera::counts() const {
    return impl_->slot.counts();
}

const std::vector<std::string>& V4l2Camera::notes() const {
    return impl_->notes;
}

}  // namespace fidservo::vision::v4l2
