// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/report/page.h"

#include "src/report/embedded.h"
#include "src/report/html.h"

#include <string_view>

#include <fmt/format.h>

namespace fidservo::report {
namespace {

std::string rendered_figures(const std::vector<KeyFigure>& figures) {
    std::string html = "<dl class=\"figures\">";
    for (const KeyFigure& figure : figures)
        html += fmt::format("<div class=\"{}\"><dt>{}</dt><dd>{}</dd></div>", class_of(figure.mood),
                            escaped(figure.label), escaped(figure.value));
    return html + "</dl>\n";
}

}  // namespace

std::string_view class_of(Mood mood) {
    switch (mood) {
        case Mood::good:
            return "good";
        case Mood::bad:
            return "bad";
        case Mood::unsure:
            return "unsure";
        case Mood::neutral:
            return "neutral";
    }
    return "neutral";
}

std::string section(const std::string& id, const std::string& heading, const std::string& html) {
    return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}\n</section>\n", id, escaped(heading), html);
}

std::string render(const Page& page) {
    std::string html = fmt::format(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
        "'unsafe-inline'; "
        "script-src 'unsafe-inline'; img-src data:\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{}</title>\n",
        escaped(page.title));
    html.append("<style>").append(embedded::uplot_css()).append(embedded::report_css()).append("</style>\n");
    html += fmt::format(
        "</head>\n<body>\n<header class=\"{}\">\n<p class=\"kind\">{}</p>\n<h1>{}</h1>\n<p "
        "class=\"subline\">{}</p>\n"
        "{}</header>\n<main>\n",
        class_of(page.mood), escaped(page.kind), escaped(page.headline), escaped(page.subline),
        rendered_figures(page.figures));
    html += page.body;
    html += "</main>\n<footer>" + page.footer + "</footer>\n";
    html.append("<script>").append(embedded::uplot_js()).append("</script>\n<script>");
    html.append(embedded::report_js()).append("</script>\n</body>\n</html>\n");
    return html;
}

}  // namespace fidservo::report
