// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Headless Chromium, driven over its debugging pipe.
#include <filesystem>
#include <memory>
#include <string>

#include <nlohmann/json_fwd.hpp>
#include <sys/types.h>

namespace fidservo::testing {

class Browser {
  public:
    /// Whether Chromium is installed.
    static bool is_installed();

    /// Starts it on a page. @param profile  a folder that does not exist yet
    Browser(const std::string& url, const std::filesystem::path& profile, int width_px = 1400,
            int height_px = 1000);
    ~Browser();
    Browser(const Browser&) = delete;
    Browser& operator=(const Browser&) = delete;

    /// The value of a JavaScript expression, as JSON text.
    std::string value_of(const std::string& expression);
    /// Waits until an expression is true. False if it is not within half a minute.
    bool eventually(const std::string& expression);
    /// A PNG of the window.
    void screenshot(const std::filesystem::path& file);

  private:
    nlohmann::json call(const std::string& method, const nlohmann::json& parameters);
    nlohmann::json next_message();

    pid_t pid_ = -1;
    int to_fd_ = -1, from_fd_ = -1;
    int calls_ = 0;
    std::string session_;
    std::string unread_;
};

}  // namespace fidservo::testing
