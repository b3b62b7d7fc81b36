#pragma once
// Text that is compiled into the program: style sheets and scripts of the reports.
#include <string_view>

namespace fidservo::embedded {

std::string_view uplot_js();  ///< uPlot, a plotting library (MIT licence)
std::string_view uplot_css();
std::string_view report_css();  ///< src/web/report.css
std::string_view report_js();   ///< src/web/report.js

}  // namespace fidservo::embedded
