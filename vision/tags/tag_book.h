// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The code book of a family in libapriltag's form.
#include "core/tag_families.h"

#include <memory>
#include <span>

struct apriltag_detector;
struct apriltag_family;

namespace fidservo::vision {

/// How tags are to be read.
struct TagReading {
    TagPrint print;  ///< family and border of the tags that are looked for
    /// The picture is mirrored: seen through the glass from behind, or by way of a mirror.
    bool mirrored = false;

    bool operator==(const TagReading&) const = default;
};

/// The largest number of code bits that may be corrected: fewer than half of the family's least Hamming
/// distance, so that the nearest code is unique; at most 2, and such that the decoding table in memory has at
/// most a million words.
int most_correctable_bits(const TagFamily& family);

/// The code book for a reading. libapriltag decodes any family whose bits are listed such that a quarter turn
/// of the tag shifts the list by a quarter of its length; every square pattern can be listed in this way,
/// with the bit in the middle last. Each border, mirroring and inversion has its own book. A book includes
/// the library's decoding table and is read-only: all detectors share it, and the last one used is kept for
/// the next detector.
/// @param corrected_bits  0 to 2
std::shared_ptr<apriltag_family> shared_tag_book(const TagReading& reading, int corrected_bits);

/// Deletes a detector, but not its books.
struct EndLibraryDetector {
    /// Deletes the detector by its library's function.
    void operator()(apriltag_detector* ended) const;
};
/// A detector of the library with unique ownership.
using LibraryDetector = std::unique_ptr<apriltag_detector, EndLibraryDetector>;

/// A detector of the library that runs in the caller's thread, on the image as it is. The books must outlive
/// it.
/// @param min_contrast  grey levels below which a neighbourhood holds no edge
LibraryDetector library_detector(std::span<const std::shared_ptr<apriltag_family>> books, int min_contrast);

}  // namespace fidservo::vision
