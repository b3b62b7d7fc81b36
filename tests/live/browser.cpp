// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/live/browser.h"

#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fidservo::testing {

namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr const char* program = "/usr/bin/chromium";
constexpr int reads_fd = 3, writes_fd = 4;  // of the browser, by its convention
constexpr int answer_limit_ms = 60'000;

[[noreturn]] void become_browser(int from_us_fd, int to_us_fd, const std::vector<std::string>& arguments) {
    // Out of the way first: one of them may have the other's place.
    const int from = ::fcntl(from_us_fd, F_DUPFD, 10), to = ::fcntl(to_us_fd, F_DUPFD, 10);
    ::dup2(from, reads_fd);
    ::dup2(to, writes_fd);
    const int nowhere = ::open("/dev/null", O_RDWR);
    for (const int fd : {0, 1, 2}) ::dup2(nowhere, fd);
    std::vector<char*> argv;
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    ::execv(program, argv.data());
    ::_exit(127);
}

std::string decoded_base64(const std::string& text) {
    std::string bytes;
    unsigned int bits = 0;
    int count = 0;
    for (const char c : text) {
        static const std::string alphabet =
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        const auto value = alphabet.find(c);
        if (value == std::string::npos) break;
        bits = (bits << 6) | static_cast<unsigned int>(value);
        if ((count += 6) >= 8) bytes.push_back(static_cast<char>((bits >> (count -= 8)) & 0xff));
    }
    return bytes;
}

}  // namespace

bool Browser::is_installed() {
    return ::access(program, X_OK) == 0;
}

Browser::Browser(const std::string& url, const std::filesystem::path& profile, int width_px, int height_px) {
    std::array<int, 2> to{}, from{};
    if (::pipe2(to.data(), O_CLOEXEC) != 0 || ::pipe2(from.data(), O_CLOEXEC) != 0)
        throw std::runtime_error("pipe");
    const std::vector<std::string> arguments{
        program,
        "--headless=new",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-dev-shm-usage",
        "--no-first-run",
        "--remote-debugging-pipe",
        "--user-data-dir=" + profile.string(),
        "--window-size=" + std::to_string(width_px) + "," + std::to_string(height_px),
        "about:blank"};
    pid_ = ::fork();
    if (pid_ == 0) {
        ::setpgid(0, 0);
        become_browser(to[0], from[1], arguments);
    }
    ::close(to[0]);
    ::close(from[1]);
    to_fd_ = to[1];
    from_fd_ = from[0];
    const json target = call("Target.createTarget", {{"url", url}});
    const json attached =
        call("Target.attachToTarget", {{"targetId", target.at("targetId")}, {"flatten", true}});
    session_ = attached.at("sessionId");
    call("Emulation.setDeviceMetricsOverride",
         {{"width", width_px}, {"height", height_px}, {"deviceScaleFactor", 1}, {"mobile", false}});
}

Browser::~Browser() {
    ::kill(-pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    ::close(to_fd_);
    ::close(from_fd_);
}

json Browser::next_message() {
    while (true) {
        if (const auto end = unread_.find('\0'); end != std::string::npos) {
            json message = json::parse(unread_.substr(0, end));
            unread_.erase(0, end + 1);
            return message;
        }
        pollfd event{from_fd_, POLLIN, 0};
        std::array<char, 65536> bytes{};
        if (::poll(&event, 1, answer_limit_ms) <= 0) throw std::runtime_error("the browser does not answer");
        const ssize_t got = ::read(from_fd_, bytes.data(), bytes.size());
        if (got <= 0) throw std::runtime_error("the browser is gone");
        unread_.append(bytes.data(), static_cast<std::size_t>(got));
    }
}

json Browser::call(const std::string& method, const json& parameters) {
    json request{{"id", ++calls_}, {"method", method}, {"params", parameters}};
    if (!session_.empty()) request["sessionId"] = session_;
    const std::string text = request.dump();
    if (::write(to_fd_, text.c_str(), text.size() + 1) != static_cast<ssize_t>(text.size() + 1))
        throw std::runtime_error("the browser does not listen");
    while (true) {
        const json message = next_message();
        if (message.value("id", 0) != calls_) continue;
        if (message.contains("error")) throw std::runtime_error(message.at("error").dump());
        return message.at("result");
    }
}

std::string Browser::value_of(const std::string& expression) {
    const json result = call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}});
    return result.at("result").value("value", json()).dump();
}

bool Browser::eventually(const std::string& expression) {
    for (int k = 0; k < 300; ++k) {
        if (value_of("Boolean(" + expression + ")") == "true") return true;
        std::this_thread::sleep_for(100ms);
    }
    return false;
}

void Browser::screenshot(const std::filesystem::path& file) {
    const json shot = call("Page.captureScreenshot", {{"format", "png"}});
    const std::string bytes = decoded_base64(shot.at("data"));
    std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace fidservo::testing
