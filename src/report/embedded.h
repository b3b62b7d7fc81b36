// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Text that is compiled into the program: style sheets and scripts of the reports and of the live page.
#include <string_view>

namespace fidservo::embedded {

std::string_view uplot_js();  ///< uPlot, a plotting library (MIT licence)
std::string_view uplot_css();
std::string_view report_css();  ///< src/web/report.css
std::string_view report_js();   ///< src/web/report.js
std::string_view fleet_js();    ///< src/web/fleet.js
std::string_view live_html();   ///< src/web/live.html
std::string_view live_css();    ///< src/web/live.css
std::string_view live_js();     ///< src/web/live.js

}  // namespace fidservo::embedded
