// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/input_error.h"

#include <string>

#include <gtest/gtest.h>

namespace fidservo::testing {

/// The message of the InputError that the action throws; a test failure if it throws none.
template <class Action>
std::string message_of(Action action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    ADD_FAILURE() << "no InputError was thrown";
    return "";
}

}  // namespace fidservo::testing
