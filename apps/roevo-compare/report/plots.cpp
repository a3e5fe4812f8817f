#include "roevo-compare/report/plots.h"

#include <atomic>
#include <regex>
#include <stdexcept>

#include "evaluation/error_statistics.h"
#include "programs/gnuplot.h"
#include "programs/interrupt.h"
#include "programs/text.h"

namespace roevo {
namespace {

// An <svg> element for a page that holds many, from gnuplot's document.
std::string inlined(const std::string& svg, int width, int height) {
    const std::size_t begin = svg.find("<svg"), end = svg.find('>', begin);
    if (begin == std::string::npos || end == std::string::npos)
        throw std::runtime_error("gnuplot drew nothing");
    // gnuplot calls its parts the same in each drawing
    static std::atomic<unsigned> drawings{0};
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
        return {inlined(drawSvgText(script, width, height), width, height), name, note};
    } catch (const Interrupted&) {
        throw;
    } catch (const NoGnuplot&) {
        throw;
    } catch (const std::runtime_error& e) {
        return {"", name, "No plot (" + name + "): " + e.what()};
    }
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
