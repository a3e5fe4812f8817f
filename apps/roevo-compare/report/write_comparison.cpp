#include <filesystem>
#include <utility>

#include "programs/atomic_file.h"
#include "roevo-compare/report/comparison.h"
#include "roevo-compare/report/documents.h"

namespace roevo {

void writeComparison(const std::string& folder, const std::vector<SequenceComparison>& sequences,
                     const ComparisonInfo& info, const std::vector<SequenceComparison>& baseline) {
    const auto results = evaluateAll(sequences);
    const auto file = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
    // All are made before the first is written, so that an interrupt does not leave new ones and old ones
    const std::string csv = csvTable(results), md = markdownTables(results, info),
                      html = htmlReport(results, info, folder, evaluateAll(baseline));
    std::vector<std::pair<std::string, std::string>> pages;
    if (results.size() > kManySequences)
        for (const SequenceResults& result : results)
            if (hasTrajectories(*result.sequence)) {
                const std::string page = pageFile(folder, *result.sequence);
                pages.emplace_back(
                    page, htmlReport({result}, info, std::filesystem::path(page).parent_path().string()));
            }
    if (!pages.empty())
        std::filesystem::create_directories(std::filesystem::path(pages[0].first).parent_path());
    for (const auto& [page, text] : pages) writeTextAtomically(page, text);
    writeTextAtomically(file("table.csv"), csv);
    writeTextAtomically(file("table.md"), md);
    writeTextAtomically(file("report.html"), html);
}

}  // namespace roevo
