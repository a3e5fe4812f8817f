#include <algorithm>
#include <deque>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <utility>

#include "programs/atomic_file.h"
#include "roevo-compare/report/comparison.h"
#include "roevo-compare/report/documents.h"
#include "roevo-compare/report/html_parts.h"
#include "roevo/options.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

using Page = std::pair<std::string, std::string>;  // path, bytes

void add(const std::string& folder, const PageFiles& files, std::vector<Page>& pages) {
    for (const auto& [name, bytes] : files.all())
        pages.emplace_back((fs::path(folder) / name).string(), bytes);
}

std::vector<Page> pagesOf(const SequenceResults& result, const ComparisonInfo& info,
                          const std::string& folder) {
    const std::string page = pageFile(folder, *result.sequence),
                      page_folder = fs::path(page).parent_path().string();
    PageFiles beside;
    std::vector<Page> pages{{page, htmlReport({result}, info, page_folder, beside)}};
    add(page_folder, beside, pages);
    return pages;
}

// Several recordings' at once: most of a page's second is other programs', gnuplot's and roevo-render's.
void addPagesOfEach(const std::vector<SequenceResults>& results, const ComparisonInfo& info,
                    const std::string& folder, std::vector<Page>& pages) {
    const auto at_once = static_cast<std::size_t>(threadCount(0));
    std::deque<std::future<std::vector<Page>>> under_way;
    const auto take = [&] {
        for (Page& page : under_way.front().get()) pages.push_back(std::move(page));
        under_way.pop_front();
    };
    for (const SequenceResults& result : results) {
        if (!hasTrajectories(*result.sequence)) continue;
        if (under_way.size() == at_once) take();
        under_way.push_back(std::async(std::launch::async, [&] { return pagesOf(result, info, folder); }));
    }
    while (!under_way.empty()) take();
}

// Files of an earlier report that are none of this one's: those to which its pages have links, and its pages.
std::vector<fs::path> leftOvers(const std::string& folder, const std::vector<Page>& pages) {
    const auto textOf = [](const fs::path& file) {
        std::ifstream in(file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    const auto has = [](const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    };
    std::string links = textOf(fs::path(folder) / "report.html");
    std::vector<fs::path> found;
    for (const char* below : {"pages", "pages/figures", "pages/views", "figures", "views"}) {
        const fs::path path = fs::path(folder) / below;
        std::error_code none;
        for (const auto& entry : fs::directory_iterator(path, none)) {
            const fs::path& file = entry.path();
            const bool is_page = path.filename() == "pages";
            const std::string text = is_page && file.extension() == ".html" ? textOf(file) : "";
            const bool is_ours = is_page
                                     ? has(text, kReportTitle)
                                     : has(links, '"' + (path.filename() / file.filename()).string() + '"');
            if (is_ours) links += text;
            if (is_ours && std::none_of(pages.begin(), pages.end(),
                                        [&](const Page& page) { return page.first == file; }))
                found.push_back(file);
        }
    }
    return found;
}

}  // namespace

void writeComparison(const std::string& folder, const std::vector<SequenceComparison>& sequences,
                     const ComparisonInfo& info, const std::vector<SequenceComparison>& baseline) {
    const auto results = evaluateAll(sequences);
    const auto file = [&](const char* name) { return (fs::path(folder) / name).string(); };
    // All are made before the first is written, so that an interrupt does not leave new ones and old ones
    PageFiles files;
    const std::string csv = csvTable(results), md = markdownTables(results, info),
                      html = htmlReport(results, info, folder, files, evaluateAll(baseline));
    std::vector<Page> pages;
    add(folder, files, pages);
    if (results.size() > kManySequences) addPagesOfEach(results, info, folder, pages);
    const std::vector<fs::path> old = leftOvers(folder, pages);
    writeTextAtomically(file("table.csv"), csv);
    writeTextAtomically(file("table.md"), md);
    for (const auto& [page, text] : pages) {
        fs::create_directories(fs::path(page).parent_path());
        writeTextAtomically(page, text);
    }
    writeTextAtomically(file("report.html"), html);
    std::error_code ignored;
    for (const fs::path& file : old) fs::remove(file, ignored);
}

}  // namespace roevo
