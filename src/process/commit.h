// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace fidservo {

/// The release's version: major.minor.patch.
const char* program_version();

/// What git calls the commit that the program was built from, "-dirty" behind it if files were changed;
/// "unknown" without git.
const char* built_from_commit();

}  // namespace fidservo
