// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/files/recording/writer.h"

#include "core/demand.h"
#include "core/failure.h"
#include "core/input_error.h"
#include "core/rig.h"
#include "core/spsc_ring.h"
#include "src/files/disk/durable_file.h"
#include "src/files/rig/plate_file.h"
#include "vision/images/image_file.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/format.h>

namespace fidservo {

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr std::size_t most_detections_per_frame = 32;
constexpr std::size_t image_ring_size = 64;
constexpr auto flush_period = 500ms;  ///< what a killed program loses at most

void make_new_folder(const fs::path& folder) {
    std::error_code error;
    if (fs::symlink_status(folder, error).type() != fs::file_type::not_found)
        throw InputError(fmt::format("{}: exists already; a recording needs a new folder", folder.string()));
    fs::create_directories(folder, error);
    if (error) throw InputError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
}

template <class T>
T take_or_throw(Result<T> result) {
    if (!result) throw RunFault(result.error().text);
    return *std::move(result);
}

void check(const Status& status) {
    if (!status) throw RunFault(status.error().text);
}

/// A frame's file name, the time's nanoseconds as EuRoC has them.
std::string image_name(TimeNs time_ns) {
    return fmt::format("{:019}.png", time_ns);
}

std::size_t detections_capacity(const RecordingOptions& options) {
    const double rate_hz = options.camera ? options.camera->frame_rate_hz : 1.0;
    return static_cast<std::size_t>(options.ring_s * rate_hz) * most_detections_per_frame + 1;
}

}  // namespace

StageColumns columns_of(const Rig& rig) {
    const bool micro = rig.micro.has_value();
    return {.macro_setpoint = true,
            .macro_command = true,
            .encoder = true,
            .micro_setpoint = micro,
            .micro_command = micro,
            .hall = micro};
}

struct RecordingWriter::Impl {
    struct ImageToKeep {
        TimeNs time_ns = 0;
        cv::Mat image;
    };

    Impl(const fs::path& folder_, const RecordingOptions& options_)
        : folder(folder_),
          options(options_),
          rows(static_cast<std::size_t>(options.ring_s / options.tick_s) + 1),
          detections(detections_capacity(options)),
          images(image_ring_size) {
        stated.name = options.name;
        stated.rig = options.rig;
        stated.experiment = options.experiment;
        stated.tick_s = options.tick_s;
        stated.encoder_zero = options.encoder_zero;
        stated.controllers = options.controllers;
        stated.is_unfinished = true;
    }

    void open_files() {
        check(write_durably(folder / "recording.yaml", description_yaml(stated, options.origin)));
        if (!options.plate.empty()) check(write_durably(folder / "plate.yaml", plate_yaml(options.plate)));
        fs::create_directories(folder / "stage0");
        stage_file.emplace(take_or_throw(DurableFile::create(folder / "stage0" / "data.csv")));
        check(stage_file->append(stage_header(options.columns)));
        if (options.camera || options.detections || options.frames) fs::create_directories(folder / "cam0");
        if (options.camera)
            check(write_durably(folder / "cam0" / "sensor.yaml", sensor_yaml(*options.camera)));
        if (options.camera || options.detections) {
            detections_file.emplace(take_or_throw(DurableFile::create(folder / "cam0" / "detections.csv")));
            check(detections_file->append(detections_header(options.corners)));
        }
        if (options.frames) {
            fs::create_directories(folder / "cam0" / "data");
            frames_file.emplace(take_or_throw(DurableFile::create(folder / "cam0" / "data.csv")));
            check(frames_file->append(frames_header()));
        }
    }

    template <class T>
    Status hand_over(SpscRing<T>& ring, T value) {
        while (!ring.push(std::move(value))) {  // NOLINT(bugprone-use-after-move): a full ring moves nothing
            if (disk_failed.load(std::memory_order_acquire)) break;
            if (options.when_full == WhenFull::fail)
                return failure(Reason::device, "the disk cannot keep up: the recorder's ring is full");
            std::this_thread::sleep_for(50us);
        }
        if (disk_failed.load(std::memory_order_acquire)) return failure(Reason::device, fault);
        return {};
    }

    /// Drains the rings until it is told to end and they are empty.
    void run() {
        bool last_round = false;
        auto last_flush = std::chrono::steady_clock::now();
        while (true) {
            Status written = drain();
            if (const auto now = std::chrono::steady_clock::now();
                written && now - last_flush > flush_period) {
                last_flush = now;
                written = flush();
            }
            if (!written) {
                fault = written.error().text;
                disk_failed.store(true, std::memory_order_release);
                return;
            }
            if (last_round) return;
            std::unique_lock lock(mutex);
            last_round = wake.wait_for(lock, 2ms, [this] { return ending; });
        }
    }

    Status drain() {
        StageRow row;
        while (rows.pop(row)) {
            line.clear();
            append_row(line, row, options.columns);
            if (auto status = stage_file->append(line); !status) return status;
        }
        TagDetection detection;
        while (detections.pop(detection)) {
            line.clear();
            append_detection(line, detection, options.corners);
            if (auto status = detections_file->append(line); !status) return status;
        }
        ImageToKeep image;
        while (images.pop(image))
            if (auto status = keep(image); !status) return status;
        return {};
    }

    Status flush() {
        for (auto* file : {&stage_file, &detections_file, &frames_file})
            if (*file)
                if (auto status = (*file)->flush(); !status) return status;
        return {};
    }

    Status keep(const ImageToKeep& frame) {
        constexpr int fast_compression = 1;
        const std::vector<unsigned char> png = vision::encode_png(frame.image, fast_compression);
        const std::string name = image_name(frame.time_ns);
        const std::string_view bytes(reinterpret_cast<const char*>(png.data()), png.size());
        if (auto status = write_durably(folder / "cam0" / "data" / name, bytes); !status) return status;
        line.clear();
        append_frame(line, {frame.time_ns, name});
        return frames_file->append(line);
    }

    Status close_files() {
        for (auto* file : {&stage_file, &detections_file, &frames_file})
            if (*file)
                if (auto status = (*file)->close(); !status) return status;
        if (auto status = write_description(); !status) return status;
        for (const fs::path& inner :
             {folder / "stage0", folder / "cam0", folder / "cam0" / "data", folder, folder.parent_path()})
            if (fs::exists(inner))
                if (auto status = sync_folder(inner); !status) return status;
        return {};
    }

    /// What is stated now takes the place of what was.
    Status write_description() {
        std::ranges::stable_sort(stated.events, {}, &RecordingEvent::time_ns);
        try {
            replace_file(folder / "recording.yaml", description_yaml(stated, options.origin));
            return {};
        } catch (const RunFault& fault_of_disk) {
            return failure(Reason::device, fault_of_disk.what());
        }
    }

    Status close(bool finished) {
        if (!thread.joinable()) return closed;
        stated.is_unfinished = !finished;
        {
            const std::lock_guard lock(mutex);
            ending = true;
        }
        wake.notify_one();
        thread.join();
        closed = disk_failed ? Status(failure(Reason::device, fault)) : close_files();
        return closed;
    }

    const fs::path folder;
    const RecordingOptions options;
    SpscRing<StageRow> rows;
    SpscRing<TagDetection> detections;
    SpscRing<ImageToKeep> images;

    Recording stated;  ///< what recording.yaml says
    std::optional<DurableFile> stage_file, detections_file, frames_file;
    std::string line;   ///< of the writing thread
    std::string fault;  ///< written before disk_failed is set
    std::atomic<bool> disk_failed = false;

    std::mutex mutex;
    std::condition_variable wake;
    bool ending = false;
    Status closed;
    std::thread thread;
};

RecordingWriter::RecordingWriter(const fs::path& folder, const RecordingOptions& options) {
    make_new_folder(folder);
    impl_ = std::make_unique<Impl>(folder, options);
    impl_->open_files();
    impl_->thread = std::thread([impl = impl_.get()] { impl->run(); });
}

RecordingWriter::~RecordingWriter() {
    static_cast<void>(impl_->close(false));
}

Status RecordingWriter::add(const StageRow& row) {
    return impl_->hand_over(impl_->rows, row);
}

Status RecordingWriter::add(const TagDetection& detection) {
    FIDSERVO_DEMAND(impl_->detections_file.has_value());
    return impl_->hand_over(impl_->detections, detection);
}

Status RecordingWriter::add_frame(TimeNs time_ns, const cv::Mat& image) {
    FIDSERVO_DEMAND(impl_->frames_file.has_value());
    return impl_->hand_over(impl_->images, Impl::ImageToKeep{time_ns, image});
}

void RecordingWriter::add(RecordingEvent event) {
    impl_->stated.events.push_back(std::move(event));
}

void RecordingWriter::set_encoder_zero(const EncoderZero& zero) {
    impl_->stated.encoder_zero = zero;
}

Status RecordingWriter::close() {
    return impl_->close(true);
}

void write_recording(const fs::path& folder, const Recording& recording,
                     const std::optional<CameraParameters>& camera, const RecordingOrigin& origin) {
    const bool has_covariances = std::ranges::any_of(
        recording.detections, [](const TagDetection& tag) { return tag.is_refined || tag.covariances_px2; });
    RecordingWriter writer(
        folder, {.name = recording.name,
                 .rig = recording.rig,
                 .experiment = recording.experiment,
                 .tick_s = recording.tick_s,
                 .encoder_zero = recording.encoder_zero,
                 .controllers = recording.controllers,
                 .origin = origin,
                 .plate = recording.plate,
                 .columns = recording.columns,
                 .camera = camera,
                 .detections = !recording.detections.empty(),
                 .corners = has_covariances ? CornerColumns::places_and_covariances : CornerColumns::places,
                 .when_full = WhenFull::wait});
    for (const StageRow& row : recording.rows) check(writer.add(row));
    for (const TagDetection& detection : recording.detections) check(writer.add(detection));
    for (const RecordingEvent& event : recording.events) writer.add(event);
    if (!recording.is_unfinished) check(writer.close());
}

}  // namespace fidservo
