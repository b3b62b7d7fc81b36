// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/live/page_time.h"

#include "tests/live/browser.h"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace fidservo::testing {

std::optional<double> page_drawn_s(const std::filesystem::path& page, const std::filesystem::path& profile) {
    if (!Browser::is_installed()) return std::nullopt;
    Browser browser("file://" + page.string(), profile);
    if (!browser.eventually("location.protocol === 'file:' && document.readyState === 'complete'"))
        throw std::runtime_error("the page does not open: " + page.string());
    (void)browser.value_of(
        "requestAnimationFrame(() => requestAnimationFrame(() => { window.drawn_ms = performance.now() }))");
    if (!browser.eventually("window.drawn_ms !== undefined"))
        throw std::runtime_error("the page is not drawn: " + page.string());
    return 1e-3 * std::atof(browser.value_of("window.drawn_ms").c_str());
}

}  // namespace fidservo::testing
