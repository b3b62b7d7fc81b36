// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace fidservo {

/// Whether the address or thread sanitizer is compiled in. Each of them maps terabytes of addresses, so that
/// no limit on a process's address space can be kept.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool has_sanitizer = true;
#elif defined(__has_feature)
inline constexpr bool has_sanitizer = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool has_sanitizer = false;
#endif

}  // namespace fidservo
