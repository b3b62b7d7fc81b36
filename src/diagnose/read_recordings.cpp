// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/read_recordings.h"

#include "src/diagnose/frame_looks.h"
#include "src/files/recording/reader.h"

#include <utility>

#include <malloc.h>

namespace fidservo::diagnose {

ReadRecordings with_frames(std::vector<Recording> recordings,
                           const std::vector<std::filesystem::path>& folders,
                           const std::function<bool()>& interrupted) {
    std::vector<std::string> notes = measure_frames(recordings, folders, interrupted);
    return {std::move(recordings), std::move(notes)};
}

ReadRecordings read_recordings(const std::vector<std::filesystem::path>& paths,
                               const std::function<bool()>& interrupted) {
    std::vector<Recording> recordings;
    std::vector<std::filesystem::path> folders;
    for (const std::filesystem::path& path : paths)
        for (const std::filesystem::path& folder : find_recordings(path)) {
            recordings.push_back(read_recording(folder));
            folders.push_back(folder);
        }
    return with_frames(std::move(recordings), folders, interrupted);
}

void keep_memory() {
#ifdef __GLIBC__
    constexpr int top_pad = 64 << 20, never = 1 << 30;
    ::mallopt(M_TOP_PAD, top_pad);
    ::mallopt(M_TRIM_THRESHOLD, never);
#endif
}

}  // namespace fidservo::diagnose
