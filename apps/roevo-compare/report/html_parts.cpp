#include "roevo-compare/report/html_parts.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "programs/text.h"

namespace roevo {
namespace {

constexpr std::size_t kManyColumns = 8;  // more are set closer
constexpr int kWideFigure = 600;         // px

std::string colourText(unsigned rgb) {
    char text[8];
    std::snprintf(text, sizeof text, "#%06X", rgb);
    return text;
}

std::string classOf(const TableCell& cell) {
    return cell.best ? " class=\"best\"" : cell.weak ? " class=\"weak\"" : "";
}

std::string headOf(const Table::Row& row) {
    std::string head = row.link.empty()
                           ? breakable(row.head)
                           : "<a href=\"" + htmlText(row.link) + "\">" + breakable(row.head) + "</a>";
    const char* kind = row.ours ? " class=\"ours\"" : row.aside ? " class=\"aside\"" : "";
    return "<th scope=\"row\"" + std::string(kind) + ">" + head + "</th>";
}

std::string groupHeads(const Table& table) {
    if (table.groups.empty()) return {};
    std::string html = "<tr><td></td>";
    for (const auto& [name, size] : table.groups)
        html += "<th scope=\"colgroup\" colspan=\"" + std::to_string(size) + "\">" + htmlText(name) + "</th>";
    return html + "</tr>\n";
}

}  // namespace

std::string element(const std::string& tag, const std::string& text) {
    return "<" + tag + ">" + htmlText(text) + "</" + tag + ">";
}

std::string breakable(const std::string& name) {
    // Signs after which a name may go on in the next line
    return replaceAll(replaceAll(htmlText(name), "/", "/<wbr/>"), "_", "_<wbr/>");
}

std::string setTable(const Table& table, const std::string& id, bool titled) {
    std::vector<std::string> notes;
    const auto mark = [&](const std::string& note) -> std::string {
        if (note.empty()) return {};
        auto at = std::find(notes.begin(), notes.end(), note);
        if (at == notes.end()) at = notes.insert(notes.end(), note);
        const std::string number = std::to_string(at - notes.begin() + 1);
        return "<sup><a href=\"#" + id + "n" + number + "\">" + number + "</a></sup>";
    };
    const auto words = [&](const Table::Row& row) { return table.text_last ? &row.cells.back() : nullptr; };
    std::string html = "<div class=\"tablebox\" id=\"" + id + "\">\n";
    if (titled) html += element("h3", table.title) + "\n";
    html += "<div class=\"scroll\" tabindex=\"0\"><table" +
            std::string(table.columns.size() > kManyColumns ? " class=\"dense\"" : "") + ">\n<thead>" +
            groupHeads(table) + "<tr><th scope=\"col\">" + htmlText(table.corner) + "</th>";
    for (const std::string& column : table.columns)
        html += (table.text_last && &column == &table.columns.back() ? "<th scope=\"col\" class=\"text\">"
                                                                     : "<th scope=\"col\">") +
                replaceAll(htmlText(column), "_", "_<wbr/>") + "</th>";
    html += "</tr></thead>\n<tbody>\n";
    for (const Table::Row& row : table.rows) {
        html += "<tr>" + headOf(row);
        for (const TableCell& cell : row.cells)
            html += "<td" + (&cell == words(row) ? " class=\"text\"" : classOf(cell)) + ">" +
                    htmlText(cell.text) + mark(cell.note) + "</td>";
        html += "</tr>\n";
    }
    html += "</tbody></table></div>\n";
    if (!notes.empty()) {
        html += "<ol class=\"notes\">";
        for (std::size_t i = 0; i < notes.size(); ++i)
            html += "<li id=\"" + id + "n" + std::to_string(i + 1) + "\">" + htmlText(notes[i]) + "</li>";
        html += "</ol>\n";
    }
    return html + "<p class=\"protocol\">" + htmlText(table.protocol) + "</p>\n</div>\n";
}

std::string lineSample(const LineStyle& style) {
    return "<svg class=\"sample\" width=\"30\" height=\"10\" viewBox=\"0 0 30 10\" "
           "xmlns=\"http://www.w3.org/2000/svg\"><line x1=\"1\" y1=\"5\" x2=\"29\" y2=\"5\" stroke=\"" +
           style.colour + "\" stroke-width=\"" + exactNumber(style.width) + "\"" +
           (style.dashes.empty() ? "" : " stroke-dasharray=\"" + style.dashes + "\"") + "/></svg>";
}

std::string lineLegend(const SequenceResults& results, const Legend& legend, bool in_space) {
    std::string items;
    const bool referenced = std::any_of(results.evaluated.begin(), results.evaluated.end(),
                                        [](const EvaluatedRun& run) { return run.evaluation.has_value(); });
    for (std::size_t i = 0; i < results.evaluated.size(); ++i) {
        const MethodRun& run = results.sequence->runs[i];
        const bool errors = results.evaluated[i].evaluation.has_value();
        if (!run.ok() || run.trajectory.empty() || (!errors && referenced)) continue;
        const std::size_t m = legend.indexOf(run.method);
        items += "<li>" + lineSample(legend.styles[m]) + htmlText(legend.methods[m].label) + "</li>";
    }
    if (items.empty()) return {};
    if (!in_space) return "<ul class=\"legend\">" + items + "</ul>\n";
    if (referenced) items = "<li>" + lineSample(groundTruthStyle()) + "ground truth</li>" + items;
    return "<ul class=\"legend\">" + items +
           "<li><svg class=\"sample\" width=\"12\" height=\"10\" viewBox=\"0 0 12 10\" "
           "xmlns=\"http://www.w3.org/2000/svg\"><circle cx=\"6\" cy=\"5\" r=\"4\" "
           "fill=\"#222222\"/></svg>start"
           "</li></ul>\n";
}

std::string stageLegend(const Figure& figure) {
    std::string items;
    for (const auto& [name, rgb] : figure.fills)
        items +=
            "<li><svg class=\"sample\" width=\"14\" height=\"14\" viewBox=\"0 0 14 14\" "
            "xmlns=\"http://www.w3.org/2000/svg\"><rect width=\"14\" height=\"14\" fill=\"" +
            colourText(rgb) + "\"/></svg>" + htmlText(name) + "</li>";
    return "<ul class=\"legend\">" + items +
           "<li><svg class=\"sample\" width=\"6\" height=\"14\" viewBox=\"0 0 6 14\" "
           "xmlns=\"http://www.w3.org/2000/svg\"><line x1=\"3\" y1=\"0\" x2=\"3\" y2=\"14\" "
           "stroke=\"#222222\" "
           "stroke-width=\"1.6\"/></svg>95th percentile</li>"
           "<li><svg class=\"sample\" width=\"12\" height=\"14\" viewBox=\"0 0 12 14\" "
           "xmlns=\"http://www.w3.org/2000/svg\"><path d=\"M6 2 L11 7 L6 12 L1 7 Z\" "
           "fill=\"#222222\"/></svg>processor time, all threads</li></ul>\n";
}

std::string PageFiles::add(const std::string& folder, const std::string& name, const std::string& extension,
                           std::string bytes) {
    constexpr std::size_t kLongest = 120;  // a file system takes 255 bytes
    std::string plain;
    for (const char c : name.substr(0, kLongest))
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.')
            plain += c;
        else if (!plain.empty() && plain.back() != '_')
            plain += '_';
    const auto address = [&](int copy) {
        return folder + "/" + plain + (copy > 1 ? "_" + std::to_string(copy) : "") + extension;
    };
    int copy = 1;
    const auto is_taken = [&](const auto& file) { return file.first == address(copy); };
    while (std::any_of(files_.begin(), files_.end(), is_taken)) ++copy;
    files_.emplace_back(address(copy), std::move(bytes));
    return files_.back().first;
}

std::string setFigure(const Figure& figure, PageFiles* files) {
    if (figure.svg.empty()) return "<p class=\"remark\">" + htmlText(figure.note) + "</p>\n";
    const std::string picture =
        replaceAll(figure.svg, "<svg class=\"plot\"",
                   "<svg class=\"plot\" role=\"img\" aria-label=\"" + htmlText(figure.name) + "\"");
    std::string caption = htmlText(figure.note);
    if (files != nullptr)
        caption += (caption.empty() ? "<a href=\"" : " <a href=\"") +
                   files->add("figures", figure.name, ".svg", standaloneSvg(figure)) + "\">SVG</a>";
    // A wide one is scrolled on a small screen, where its text would become too small
    return std::string("<figure") + (figure.width > kWideFigure ? " class=\"wide\"" : "") + "><div>" +
           picture + "</div>" + (caption.empty() ? "" : "<figcaption>" + caption + "</figcaption>") +
           "</figure>\n";
}

std::string relativeLink(const std::string& target, const std::string& from_folder) {
    if (target.empty()) return {};
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path from = fs::absolute(from_folder, error), to = fs::absolute(target, error);
    const std::string path = to.lexically_normal().lexically_relative(from.lexically_normal()).string();
    std::string link;
    for (const char c : path) {
        const auto byte = static_cast<unsigned char>(c);
        if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
            std::string("-._~/").find(c) != std::string::npos) {
            link += c;
        } else {
            char code[4];
            std::snprintf(code, sizeof code, "%%%02X", byte);
            link += code;
        }
    }
    return link;
}

}  // namespace roevo
