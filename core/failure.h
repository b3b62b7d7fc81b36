#pragma once
// Failures at run time are values with a reason; mistakes of the user are exceptions; mistakes of the
// programmer abort.
#include <stdexcept>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace fidservo {

/// Why something that can go wrong on a healthy program did not yield a value.
enum class Reason {
    no_tag,             ///< no fiducial in the image
    wrong_tag,          ///< a fiducial, but not the one expected at this place
    several_tags,       ///< the expected fiducial is there more than once
    occluded,           ///< the fiducial is partly hidden
    glare,              ///< the fiducial is partly saturated
    not_at_rest,        ///< the stage moves: nothing may be measured
    no_convergence,     ///< an iteration or a motion did not reach its goal in the time allowed
    out_of_reach,       ///< the stage cannot go there
    not_identifiable,   ///< the data do not determine the quantity
    feature_not_found,  ///< a printed feature is not where it should be
    no_image,           ///< the image that was to be measured again is not there
    device,             ///< a camera or a stage failed
    timeout,            ///< nothing arrived in the time allowed
    stopped,            ///< the user or the guardian ended the run
};

/// The word that stands for a reason in result files, e.g. "no_tag".
std::string_view name_of(Reason reason);

/// Whether nothing is worth trying after it: a device failed, or the run was stopped.
constexpr bool ends_the_run(Reason reason) {
    return reason == Reason::device || reason == Reason::stopped;
}

struct Failure {
    Reason reason;
    std::string text;  ///< one line for people, without the reason's name
};

/// A value or the reason why there is none.
template <class T>
class [[nodiscard]] Result : public tl::expected<T, Failure> {
  public:
    using tl::expected<T, Failure>::expected;
};

using Status = Result<void>;

inline tl::unexpected<Failure> failure(Reason reason, std::string text) {
    return tl::make_unexpected(Failure{reason, std::move(text)});
}

/// Something that the user gave is wrong: a file, a key, a value, an option. One line; exit code 2.
class InputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A device or the run itself failed beyond repair. One line; exit code 3.
class RunFault : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

[[noreturn]] void abort_on_broken_demand(const char* condition, const char* file, int line);

}  // namespace fidservo

/// A condition that only a mistake in this program can break.
#define FIDSERVO_DEMAND(condition) \
    ((condition) ? void() : ::fidservo::abort_on_broken_demand(#condition, __FILE__, __LINE__))
