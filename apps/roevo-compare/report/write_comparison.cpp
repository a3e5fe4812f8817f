#include <deque>
#include <filesystem>
#include <future>
#include <utility>

#include "programs/atomic_file.h"
#include "roevo-compare/report/comparison.h"
#include "roevo-compare/report/documents.h"
#include "roevo-compare/report/html_parts.h"
#include "roevo/options.h"

namespace roevo {
namespace {

using Page = std::pair<std::string, std::string>;  // path, bytes

void add(const std::string& folder, const PageFiles& files, std::vector<Page>& pages) {
    for (const auto& [name, bytes] : files.all())
        pages.emplace_back((std::filesystem::path(folder) / name).string(), bytes);
}

std::vector<Page> pagesOf(const SequenceResults& result, const ComparisonInfo& info,
                          const std::string& folder) {
    const std::string page = pageFile(folder, *result.sequence),
                      page_folder = std::filesystem::path(page).parent_path().string();
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

}  // namespace

void writeComparison(const std::string& folder, const std::vector<SequenceComparison>& sequences,
                     const ComparisonInfo& info, const std::vector<SequenceComparison>& baseline) {
    const auto results = evaluateAll(sequences);
    const auto file = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
    // All are made before the first is written, so that an interrupt does not leave new ones and old ones
    PageFiles files;
    const std::string csv = csvTable(results), md = markdownTables(results, info),
                      html = htmlReport(results, info, folder, files, evaluateAll(baseline));
    std::vector<Page> pages;
    add(folder, files, pages);
    if (results.size() > kManySequences) addPagesOfEach(results, info, folder, pages);
    writeTextAtomically(file("table.csv"), csv);
    writeTextAtomically(file("table.md"), md);
    for (const auto& [page, text] : pages) {
        std::filesystem::create_directories(std::filesystem::path(page).parent_path());
        writeTextAtomically(page, text);
    }
    writeTextAtomically(file("report.html"), html);
}

}  // namespace roevo
