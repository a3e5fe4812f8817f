#include "roevo-compare/report/line_style.h"

#include <algorithm>
#include <array>

#include "programs/text.h"
#include "roevo-compare/report/ranking.h"

namespace roevo {
namespace {

// Okabe and Ito's palette without the blues, which are ours, the yellow, which is too pale for a line, and
// the second orange; and two that stay apart from these.
constexpr std::array<const char*, 6> kForeign{"#D55E00", "#009E73", "#CC79A7",
                                              "#222222", "#A08C00", "#7A4B16"};
constexpr std::array<const char*, 3> kForeignDashes{"", "7,3", "2,3"};

// From the fullest mode on.
const std::array<LineStyle, 4> kOurs{LineStyle{"#0072B2", 3.2, ""}, LineStyle{"#56B4E9", 2.4, ""},
                                     LineStyle{"#0072B2", 1.8, "5,3"}, LineStyle{"#56B4E9", 1.8, "2,3"}};

}  // namespace

std::vector<LineStyle> lineStyles(const std::vector<TableMethod>& methods) {
    std::vector<LineStyle> styles(methods.size());
    std::vector<std::size_t> ours;
    for (std::size_t i = 0; i < methods.size(); ++i)
        if (isOurs(methods[i].name)) ours.push_back(i);
    std::stable_sort(ours.begin(), ours.end(), [&](std::size_t a, std::size_t b) {
        return fullnessOf(methods[a].name) > fullnessOf(methods[b].name);
    });
    for (std::size_t k = 0; k < ours.size(); ++k) styles[ours[k]] = kOurs[std::min(k, kOurs.size() - 1)];
    std::size_t foreign = 0;
    for (std::size_t i = 0; i < methods.size(); ++i)
        if (!isOurs(methods[i].name)) {
            const std::size_t round = std::min(foreign / kForeign.size(), kForeignDashes.size() - 1);
            styles[i] = {kForeign[foreign % kForeign.size()], 1.4, kForeignDashes[round]};
            ++foreign;
        }
    return styles;
}

std::string gnuplotStyle(const LineStyle& style) {
    // gnuplot's lengths grow with the width of the line
    return "lc rgb '" + style.colour + "' lw " + exactNumber(style.width) + " dt " +
           (style.dashes.empty() ? "1" : "(" + style.dashes + ")");
}

LineStyle groundTruthStyle() {
    return {"#C4C4C4", 6, ""};
}

unsigned stageRgb(std::size_t index) {
    // Paul Tol's light scheme, made for areas; four more, darker, for when the methods have many stages
    static constexpr std::array<unsigned, 12> colours{0x77AADD, 0xEE8866, 0xEEDD88, 0xFFAABB,
                                                      0x99DDFF, 0x44BB99, 0xBBCC33, 0xAAAA00,
                                                      0xB58BC4, 0x5C7FA3, 0xB07A5B, 0x8C8C8C};
    return index == kNoStage ? 0xDDDDDD : colours[index % colours.size()];
}

}  // namespace roevo
