// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// A result or the reason why there is none: failures at run time are values, not exceptions.
#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace fidservo {

enum class Reason;  ///< core/failure.h lists them

struct Failure {
    Reason reason;     ///< the kind of failure, for programs
    std::string text;  ///< one line for people, without the reason's name
};

/// A value or the reason why there is none.
template <class T>
class [[nodiscard]] Result : public tl::expected<T, Failure> {
  public:
    using tl::expected<T, Failure>::expected;
};

/// Success without a value, or the reason why something was not done.
using Status = Result<void>;

/// The failure that a function returns in place of a value.
inline tl::unexpected<Failure> failure(Reason reason, std::string text) {
    return tl::make_unexpected(Failure{reason, std::move(text)});
}

}  // namespace fidservo
