// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/live/live_server.h"

#include "core/input_error.h"
#include "tests/live/browser.h"
#include "tests/live/shown_run.h"
#include "tests/src/temporary_folder.h"

#include <atomic>
#include <optional>
#include <thread>

#include <gtest/gtest.h>
#include <httplib.h>

namespace fidservo {
namespace {

class LivePage : public ::testing::Test {
  protected:
    LivePage() {
        server_.emplace(0, feed_, reference_rig(), [this] { ++stops_; });
    }

    std::string host() const { return "127.0.0.1:" + std::to_string(server_->port()); }
    httplib::Client client() const { return httplib::Client("127.0.0.1", server_->port()); }

    std::shared_ptr<LiveFeed> feed_ = std::make_shared<LiveFeed>();
    std::atomic<int> stops_ = 0;
    std::optional<LiveServer> server_;
};

TEST_F(LivePage, Pages_AreThere) {
    for (const char* path : {"/", "/live.css", "/live.js", "/uplot.css", "/uplot.js"}) {
        const auto answer = client().Get(path);
        ASSERT_TRUE(answer) << path;
        EXPECT_EQ(answer->status, 200) << path;
        EXPECT_GT(answer->body.size(), 500U) << path;
        EXPECT_NE(answer->get_header_value("Content-Security-Policy").find("default-src 'none'"),
                  std::string::npos);
    }
    EXPECT_EQ(client().Get("/elsewhere")->status, 404);
    EXPECT_EQ(client().Get("/picture.jpg")->status, 404) << "there is none yet";
}

TEST_F(LivePage, StopAndPause_ReachTheRun) {
    EXPECT_EQ(client().Post("/pause")->status, 200);
    EXPECT_TRUE(feed_->pause_is_asked());
    EXPECT_EQ(client().Post("/go-on")->status, 200);
    EXPECT_FALSE(feed_->pause_is_asked());
    EXPECT_EQ(client().Post("/stop", httplib::Headers{{"Origin", "http://" + host()}}, "", "")->status, 200);
    EXPECT_EQ(stops_, 1);
    EXPECT_EQ(client().Get("/stop")->status, 404) << "a link cannot stop a run";
    EXPECT_EQ(stops_, 1);
}

TEST_F(LivePage, OtherSites_AreRefused) {
    for (const char* origin : {"http://example.org", "null", "https://127.0.0.1", "http://127.0.0.1:1"}) {
        EXPECT_EQ(client().Post("/stop", httplib::Headers{{"Origin", origin}}, "", "")->status, 403)
            << origin;
        EXPECT_EQ(client().Post("/pause", httplib::Headers{{"Origin", origin}}, "", "")->status, 403)
            << origin;
    }
    for (const char* name : {"example.org", "127.0.0.1", "localhost:1"})
        for (const char* path : {"/", "/events", "/picture.jpg"})
            EXPECT_EQ(client().Get(path, httplib::Headers{{"Host", name}})->status, 403) << name << path;
    EXPECT_EQ(client().Post("/stop", httplib::Headers{{"Host", "example.org"}}, "", "")->status, 403);
    EXPECT_EQ(stops_, 0);
    EXPECT_FALSE(feed_->pause_is_asked());
}

TEST_F(LivePage, PortThatIsTaken_IsRefused) {
    EXPECT_THROW(LiveServer(server_->port(), feed_, reference_rig(), [] {}), RunFault);
}

TEST_F(LivePage, ServerThatEndsAtOnce_Ends) {
    for (int k = 0; k < 300; ++k) LiveServer(0, feed_, reference_rig(), [] {});
}

TEST_F(LivePage, Events_TellWhatTheRunShowsAndItsEnd) {
    testing::show_run(*feed_);
    std::string text;
    std::thread listener([&, client = client()]() mutable {
        client.set_read_timeout(20);
        client.Get("/events", [&](const char* bytes, std::size_t count) {
            text.append(bytes, count);
            return true;
        });
    });
    auto pictures = client();
    for (int k = 0; k < 100 && pictures.Get("/picture.jpg")->status != 200; ++k)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    feed_->is_at({"Demo plate", "stopped", "site 12: stopped by the user", {}});
    server_.reset();
    listener.join();
    EXPECT_NE(text.find(R"("activity":"site 12")"), std::string::npos) << text.substr(0, 500);
    EXPECT_NE(text.find("site 12: stopped by the user"), std::string::npos) << "the last word is sent";
    EXPECT_NE(text.find("event: end"), std::string::npos);
}

TEST_F(LivePage, InABrowser_ShowsTheRunAndStopsIt) {
    if (!testing::Browser::is_installed()) GTEST_SKIP() << "no Chromium on this machine";
    testing::show_run(*feed_);
    const testing::TemporaryFolder folder;
    testing::Browser browser(server_->url(), folder / "profile");
    EXPECT_TRUE(browser.eventually("document.getElementById('activity').textContent === 'site 12'"));
    EXPECT_TRUE(browser.eventually("document.querySelectorAll('#sites g').length === 3"));
    EXPECT_TRUE(
        browser.eventually("document.querySelector('#sites .good title').textContent.includes('site 11')"));
    EXPECT_TRUE(browser.eventually("document.getElementById('frame').textContent.includes('tag 12')"));
    const std::string pixel = "[...document.getElementById('picture').getContext('2d').getImageData(";
    EXPECT_TRUE(browser.eventually(pixel + "420,360,1,1).data][0] < 60")) << "the square, from the JPEG";
    EXPECT_TRUE(
        browser.eventually(pixel + "480,472,1,1).data][1] > 150 && " + pixel + "480,472,1,1).data][0] < 120"))
        << "the green outline, at the lower edge of the tag";
    EXPECT_EQ(browser.value_of("data[0].length"), "1000");
    EXPECT_EQ(browser.value_of("document.querySelectorAll('canvas').length"), "3");
    if (const char* file = std::getenv("FIDSERVO_SCREENSHOT")) browser.screenshot(file);

    browser.value_of("document.getElementById('pause').click()");
    EXPECT_TRUE(browser.eventually("document.getElementById('pause').textContent === 'Go on'"));
    for (int k = 0; k < 100 && !feed_->pause_is_asked(); ++k)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_TRUE(feed_->pause_is_asked());
    browser.value_of("document.getElementById('stop').click()");
    for (int k = 0; k < 100 && stops_ == 0; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(stops_, 1);

    feed_->is_at({"Demo plate", "stopped", "site 12: stopped by the user", {}});
    server_.reset();
    EXPECT_TRUE(browser.eventually(
        "document.getElementById('reason').textContent === 'site 12: stopped by the user'"));
    EXPECT_TRUE(browser.eventually("document.getElementById('stop').disabled"));
}

}  // namespace
}  // namespace fidservo
