// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// What can go wrong at run time is a value: a result, or the reason why there is none.
#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace fidservo {

enum class Reason;  ///< core/failure.h lists them

struct Failure {
    Reason reason;     ///< for programs
    std::string text;  ///< one line for people, without the reason's name
};

/// A value or the reason why there is none.
template <class T>
class [[nodiscard]] Result : public tl::expected<T, Failure> {
  public:
    using tl::expected<T, Failure>::expected;
};

/// Nothing, or the reason why it was not done.
using Status = Result<void>;

/// What a function returns that has no value to give.
inline tl::unexpected<Failure> failure(Reason reason, std::string text) {
    return tl::make_unexpected(Failure{reason, std::move(text)});
}

}  // namespace fidservo
