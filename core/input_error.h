// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The two exceptions that end the program; each carries one line for the user.
#include <stdexcept>

namespace fidservo {

/// Something that the user gave is wrong: a file, a key, a value, an option. Exit code 2.
class InputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A device or the run itself failed beyond repair. Exit code 3.
class RunFault : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

}  // namespace fidservo
