// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/live/live_server.h"

#include "core/input_error.h"
#include "src/live/live_board.h"
#include "src/report/embedded.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <string_view>
#include <thread>

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>

namespace fidservo {

namespace {

using namespace std::chrono_literals;

constexpr const char* loopback = "127.0.0.1";
constexpr auto collect_period = 50ms;
constexpr double longest_silence_s = 1.0;  ///< of the event stream: a client that is gone is noticed then
constexpr int most_viewers = 4;

constexpr const char* security_policy =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self'; connect-src "
    "'self'; "
    "frame-ancestors 'none'";

void answer(httplib::Response& response, std::string_view text, const char* type) {
    response.set_content(text.data(), text.size(), type);
}

}  // namespace

struct LiveServer::Impl {
    Impl(std::shared_ptr<LiveFeed> to_show, const Rig& rig, std::function<void()> to_stop)
        : feed(std::move(to_show)), board(feed, rig), stop(std::move(to_stop)) {}

    /// Whether a request comes from a page that this server gave to a browser on this machine.
    bool is_ours(const httplib::Request& request) const {
        const std::array hosts{fmt::format("{}:{}", loopback, port), fmt::format("localhost:{}", port)};
        const auto is_host = [&](const std::string& text) {
            return std::ranges::find(hosts, text) != hosts.end();
        };
        if (!is_host(request.get_header_value("Host"))) return false;
        if (!request.has_header("Origin")) return true;
        const std::string origin = request.get_header_value("Origin");
        return origin.starts_with("http://") && is_host(origin.substr(7));
    }

    void add_pages() {
        const auto page = [&](const char* path, auto text, const char* type) {
            server.Get(path, [text, type](const httplib::Request&, httplib::Response& response) {
                answer(response, text(), type);
            });
        };
        page("/", embedded::live_html, "text/html; charset=utf-8");
        page("/live.css", embedded::live_css, "text/css");
        page("/live.js", embedded::live_js, "text/javascript");
        page("/uplot.css", embedded::uplot_css, "text/css");
        page("/uplot.js", embedded::uplot_js, "text/javascript");
        server.Get("/picture.jpg", [this](const httplib::Request&, httplib::Response& response) {
            const auto jpeg = board.picture();
            if (!jpeg) {
                response.status = 404;
                return;
            }
            answer(response, *jpeg, "image/jpeg");
        });
        server.Get("/events",
                   [this](const httplib::Request&, httplib::Response& response) { events(response); });
    }

    void add_orders() {
        const auto order = [&](const char* path, std::function<void()> action) {
            server.Post(path,
                        [action = std::move(action)](const httplib::Request&, httplib::Response& response) {
                            action();
                            answer(response, "{}", "application/json");
                        });
        };
        order("/stop", stop);
        order("/pause", [this] { feed->ask_pause(true); });
        order("/go-on", [this] { feed->ask_pause(false); });
    }

    /// A stream of server-sent events until the browser or the run goes.
    void events(httplib::Response& response) {
        if (viewers.fetch_add(1) >= most_viewers) {
            viewers.fetch_sub(1);
            response.status = 503;
            return;
        }
        const auto told = std::make_shared<LiveBoard::Told>();
        response.set_chunked_content_provider(
            "text/event-stream",
            [this, told](std::size_t, httplib::DataSink& sink) {
                const bool last = ending.load();
                const std::string news = board.news(*told, last ? 0.0 : longest_silence_s);
                const std::string event = news.empty() ? ":\n\n" : fmt::format("data: {}\n\n", news);
                if (!sink.write(event.data(), event.size())) return false;
                if (last) {
                    const std::string_view bye = "event: end\ndata: {}\n\n";
                    sink.write(bye.data(), bye.size());
                    sink.done();
                }
                std::this_thread::sleep_for(collect_period);
                return true;
            },
            [this](bool) { viewers.fetch_sub(1); });
    }

    void listen(int wanted) {
        server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
            if (is_ours(request)) return httplib::Server::HandlerResponse::Unhandled;
            response.status = 403;
            return httplib::Server::HandlerResponse::Handled;
        });
        server.set_default_headers({{"Content-Security-Policy", security_policy},
                                    {"X-Content-Type-Options", "nosniff"},
                                    {"Cache-Control", "no-store"}});
        server.set_payload_max_length(1024);
        server.set_tcp_nodelay(true);
        // The library's own choice would let another process listen at the same port.
        server.set_socket_options([](socket_t socket) {
            const int yes = 1;
            ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        });
        add_pages();
        add_orders();
        port = wanted == 0 ? server.bind_to_any_port(loopback)
                           : (server.bind_to_port(loopback, wanted) ? wanted : -1);
        if (port <= 0) throw RunFault(fmt::format("--live {}: the port cannot be had", wanted));
        listener = std::jthread([this] {
            server.listen_after_bind();
            has_listened = true;
        });
        collector = std::jthread([this](const std::stop_token& end) {
            while (!end.stop_requested()) {
                board.collect();
                std::this_thread::sleep_for(collect_period);
            }
            board.collect();
        });
    }

    void end() {
        collector.request_stop();
        collector.join();
        ending = true;
        for (int k = 0; k < 30 && viewers > 0; ++k) std::this_thread::sleep_for(collect_period);
        // The library forgets a stop that comes before it listens.
        while (!server.is_running() && !has_listened) std::this_thread::sleep_for(1ms);
        server.stop();
    }

    std::shared_ptr<LiveFeed> feed;
    LiveBoard board;
    std::function<void()> stop;
    int port = 0;
    std::atomic<int> viewers = 0;
    std::atomic<bool> ending = false, has_listened = false;
    httplib::Server server;
    std::jthread listener, collector;
};

LiveServer::LiveServer(int port, std::shared_ptr<LiveFeed> feed, const Rig& rig, std::function<void()> stop)
    : impl_(std::make_unique<Impl>(std::move(feed), rig, std::move(stop))) {
    impl_->listen(port);
}

LiveServer::~LiveServer() {
    impl_->end();
}

int LiveServer::port() const {
    return impl_->port;
}

std::string LiveServer::url() const {
    return fmt::format("http://{}:{}/", loopback, impl_->port);
}

}  // namespace fidservo
