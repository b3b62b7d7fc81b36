// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The code book of a family as libapriltag takes it.
#include "core/tag_families.h"

#include <memory>
#include <span>

struct apriltag_detector;
struct apriltag_family;

namespace fidservo::vision {

/// As which tags are looked for.
struct TagReading {
    TagPrint print;         ///< of the tags that are looked for
    bool mirrored = false;  ///< the picture is: seen through the glass, from behind, by way of a mirror

    bool operator==(const TagReading&) const = default;
};

/// Code bits that may be corrected: fewer than half of those in which two codes differ, so that a code has
/// one nearest; 2 at most, and no more than a table of a million words, which is kept in memory, has room
/// for.
int most_correctable_bits(const TagFamily& family);

/// The library decodes any family whose bits are listed so that a quarter turn moves each by a quarter of
/// them, which can be had of every square pattern; a bit in the middle comes last. Borders, mirrored and
/// inverted prints are books of their own. The library's table for decoding comes with it and is only read:
/// one book serves all detectors that want it at a time, and the last one is kept for the next that does.
/// @param corrected_bits  0 to 2
std::shared_ptr<apriltag_family> shared_tag_book(const TagReading& reading, int corrected_bits);

/// Ends a detector, not the books that it was given.
struct EndLibraryDetector {
    /// Gives the detector back to its library.
    void operator()(apriltag_detector* ended) const;
};
/// The library's detector, owned.
using LibraryDetector = std::unique_ptr<apriltag_detector, EndLibraryDetector>;

/// A detector of the library that runs in the caller's thread, on the image as it is. The books must outlive
/// it.
/// @param min_contrast  grey levels below which a neighbourhood holds no edge
LibraryDetector library_detector(std::span<const std::shared_ptr<apriltag_family>> books, int min_contrast);

}  // namespace fidservo::vision
