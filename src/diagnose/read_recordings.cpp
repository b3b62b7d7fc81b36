// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/diagnose/read_recordings.h"

#include "src/diagnose/frame_looks.h"
#include "src/files/recording/reader.h"

#include <malloc.h>

namespace fidservo::diagnose {

ReadRecordings read_recordings(const std::vector<std::filesystem::path>& paths) {
    ReadRecordings read;
    std::vector<std::filesystem::path> folders;
    for (const std::filesystem::path& path : paths)
        for (const std::filesystem::path& folder : find_recordings(path)) {
            read.recordings.push_back(read_recording(folder));
            folders.push_back(folder);
        }
    read.notes = measure_frames(read.recordings, folders);
    return read;
}

void keep_memory() {
#ifdef __GLIBC__
    constexpr int top_pad = 64 << 20, never = 1 << 30;
    ::mallopt(M_TOP_PAD, top_pad);
    ::mallopt(M_TRIM_THRESHOLD, never);
#endif
}

}  // namespace fidservo::diagnose
