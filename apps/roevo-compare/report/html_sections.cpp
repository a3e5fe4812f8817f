#include "roevo-compare/report/html_sections.h"

#include "programs/text.h"
#include "roevo-compare/report/baseline.h"
#include "roevo-compare/report/html_parts.h"

namespace roevo {
namespace {

constexpr std::size_t kMostChanged = 10;  // recordings in each direction

}  // namespace

std::string pageHead(const std::string& title) {
    return "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta "
           "charset=\"utf-8\"/>\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
           "<title>" +
           htmlText(title) + "</title>\n<style>" + pageStyle() + "</style>\n</head>\n<body>\n";
}

std::string remark(const std::string& text) {
    return "<p class=\"remark\">" + htmlText(text) + "</p>\n";
}

std::string methodList(const Legend& legend) {
    std::string html = "<section id=\"Methods\">\n<h2>Methods</h2>\n<dl class=\"methods\">\n";
    for (std::size_t m = 0; m < legend.methods.size(); ++m)
        html += "<dt>" + lineSample(legend.styles[m]) + htmlText(legend.methods[m].label) + "</dt>" +
                element("dd", legend.methods[m].note) + "\n";
    return html + "</dl>\n</section>\n";
}

std::string protocolSection(const Conditions& conditions) {
    std::string html = "<section id=\"Protocol\">\n<h2>Protocol</h2>\n<ul class=\"lines\">\n";
    for (const std::string& line : protocolLines(conditions)) html += element("li", line) + "\n";
    return html + "</ul>\n</section>\n";
}

std::string repeating(const ComparisonInfo& info) {
    std::string html = "<section id=\"Repeating\">\n<h2>Repeating it</h2>\n" + element("pre", info.command) +
                       "\n<table>\n<tbody>\n";
    const auto row = [&](const std::string& name, const std::string& value) {
        html += "<tr><th scope=\"row\">" + htmlText(name) + "</th><td class=\"text\">" + htmlText(value) +
                "</td></tr>\n";
    };
    row("Date", info.date);
    row("Machine", info.machine);
    for (const auto& [name, version] : info.versions) row(name, version);
    return html + "</tbody></table>\n</section>\n";
}

std::string changesSection(const std::vector<SequenceResults>& results,
                           const std::vector<SequenceResults>& baseline) {
    if (baseline.empty()) return {};
    const auto changes = changesSince(baseline, results);
    if (changes.empty()) return {};  // a note says so
    std::string html = "<section id=\"Changes\">\n<h2>Against the earlier comparison</h2>\n";
    html += setTable(changeTable(changes), "changes", false);
    for (std::size_t i = 0; i < changes.size(); ++i) {
        const Table table = changedRecordings(changes[i], kMostChanged);
        if (!table.rows.empty()) html += setTable(table, "changed" + std::to_string(i));
    }
    return html + "</section>\n";
}

}  // namespace roevo
