// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Information in the names of images and videos: their kind, their order, and times.
#include "core/time.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fidservo {

/// The endings, in small letters, of images and of videos that are read.
const std::vector<std::string_view>& image_endings();
const std::vector<std::string_view>& video_endings();

bool is_named_as_image(const std::filesystem::path& file);
bool is_named_as_video(const std::filesystem::path& file);

/// Natural order of names: digits compare as numbers, the rest byte by byte.
bool natural_less(std::string_view a, std::string_view b);

/// How the names of a folder's images state times.
enum class NameTimes {
    automatic,  ///< as detected by names_unit()
    none,
    s,
    ms,
    us,
    ns
};

/// Parses the option --name-times: s, ms, us, ns, none; "" is automatic. Empty for any other word.
std::optional<NameTimes> name_times_of(std::string_view word);
std::string_view word_for(NameTimes unit);

/// A name without its ending as a time: digits, and for s, ms and us a fraction if there is one, in that
/// unit. Digits beyond the nanosecond are dropped. Empty: it is no such number, or beyond what TimeNs holds.
std::optional<TimeNs> time_in_name(std::string_view stem, NameTimes unit);

/// Detects times in names, given without their endings:
///   all whole numbers of 19 digits: ns since 1970, as EuRoC's data sets and kalibr name images;
///   all of ten digits, a dot and a fraction: s since 1970, as TUM's data sets do;
///   anything else: none.
NameTimes names_unit(const std::vector<std::string>& stems);

/// Whether all names could be times in ms or us since 1970, whole numbers of 13 or of 16 digits; which of
/// them it is cannot be known.
bool could_be_times(const std::vector<std::string>& stems);

}  // namespace fidservo
