#include "roevo-compare/report/plots.h"

#include <cstdio>
#include <regex>
#include <stdexcept>

#include "evaluation/error_statistics.h"
#include "programs/gnuplot.h"
#include "programs/interrupt.h"
#include "programs/text.h"

namespace roevo {
namespace {

constexpr int kLegendLine = 24, kLegendLeft = 20, kLegendText = 52;  // px
constexpr double kPixelsByCharacter = 8.6;                           // of 14 px, on the whole

// An <svg> element for a page that holds many, from gnuplot's document.
std::string inlined(const std::string& svg, int width, int height) {
    const std::size_t begin = svg.find("<svg"), end = svg.find('>', begin);
    if (begin == std::string::npos || end == std::string::npos)
        throw std::runtime_error("gnuplot drew nothing");
    // gnuplot calls its parts the same in each drawing. A page is made by one thread
    static thread_local unsigned drawings = 0;
    const std::string own = "p" + std::to_string(drawings++) + "_";
    std::string body = svg.substr(end + 1);
    for (const char* reference : {" id=\"", " id='", "xlink:href='#", "xlink:href=\"#", "url(#", "url('#"})
        body = replaceAll(body, reference, reference + own);
    // Tooltips with gnuplot's own names say nothing.
    body = std::regex_replace(body, std::regex("<title>[^<]*</title>|<desc>[^<]*</desc>"), "");
    return "<svg class=\"plot\" viewBox=\"0 0 " + std::to_string(width) + " " + std::to_string(height) +
           "\" xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\">" + body;
}

}  // namespace

std::size_t Legend::indexOf(const std::string& method) const {
    for (std::size_t i = 0; i < methods.size(); ++i)
        if (methods[i].name == method) return i;
    throw std::out_of_range("no method " + method);
}

Figure drawFigure(const std::string& script, int width, int height, const std::string& name,
                  const std::string& note) {
    try {
        return {
            inlined(drawSvgText(script, width, height), width, height), name, note, {}, {}, width, height};
    } catch (const Interrupted&) {
        throw;
    } catch (const NoGnuplot&) {
        throw;
    } catch (const std::runtime_error& e) {
        return {"", name, "No plot (" + name + "): " + e.what()};
    }
}

std::string withLeast(const std::string& note, double lowest, double least) {
    if (lowest > least) return note;
    return note + (note.empty() ? "" : " ") + "Less than " + plainNumber(least) + " is drawn as that.";
}

std::string standaloneSvg(const Figure& figure) {
    std::string items;
    int x = kLegendLeft, y = figure.height + kLegendLine / 2;
    const auto add = [&](const std::string& sample, const std::string& name) {
        const int width = kLegendText + static_cast<int>(kPixelsByCharacter * double(countCharacters(name)));
        if (x > kLegendLeft && x + width > figure.width) x = kLegendLeft, y += kLegendLine;
        items += "<g transform=\"translate(" + std::to_string(x) + "," + std::to_string(y) + ")\">" + sample +
                 "<text x=\"" + std::to_string(kLegendText - 16) + "\" y=\"5\">" + htmlText(name) +
                 "</text></g>\n";
        x += width;
    };
    for (const auto& [name, style] : figure.lines)
        add("<line x2=\"28\" stroke=\"" + style.colour + "\" stroke-width=\"" + exactNumber(style.width) +
                (style.dashes.empty() ? "" : "\" stroke-dasharray=\"" + style.dashes) + "\"/>",
            name);
    for (const auto& [name, rgb] : figure.fills) {
        char colour[8];
        std::snprintf(colour, sizeof colour, "#%06X", rgb);
        add(std::string("<rect x=\"8\" y=\"-7\" width=\"14\" height=\"14\" fill=\"") + colour + "\"/>", name);
    }
    const int height = items.empty() ? figure.height : y + kLegendLine / 2;
    const std::string head = figure.svg.substr(0, figure.svg.find('>') + 1);
    std::string svg = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n" + figure.svg;
    const std::string size = std::to_string(figure.width) + "\" height=\"" + std::to_string(height);
    svg = replaceAll(
        svg, head,
        "<svg width=\"" + size + "\" viewBox=\"0 0 " + std::to_string(figure.width) + " " +
            std::to_string(height) +
            "\" xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\">\n"
            "<title>" +
            htmlText(figure.name) + "</title>\n<rect width=\"" + size + "\" fill=\"#fff\"/>");
    return svg.insert(
        svg.rfind("</svg>"),
        "<g font-family=\"Helvetica,Arial,sans-serif\" font-size=\"14\" fill=\"#333\">\n" + items + "</g>\n");
}

std::vector<StampedPose> aligned(const std::vector<StampedPose>& trajectory, const Evaluation& evaluation) {
    std::vector<StampedPose> poses = trajectory;
    for (StampedPose& pose : poses)
        pose.T_world_camera = evaluation.ate.T_reference_estimate * pose.T_world_camera;
    return poses;
}

double largestStep(const std::vector<double>& times) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
    return 3.5 * percentile(steps, 0.5);
}

std::vector<std::size_t> evenly(std::size_t count, std::size_t limit) {
    std::vector<std::size_t> chosen;
    const std::size_t steps = std::min(count, limit);
    for (std::size_t k = 0; k < steps; ++k)
        chosen.push_back(steps == count ? k : k * (count - 1) / std::max<std::size_t>(steps - 1, 1));
    return chosen;
}

}  // namespace roevo
