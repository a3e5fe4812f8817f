#include <filesystem>
#include <utility>

#include "programs/atomic_file.h"
#include "roevo-compare/report/comparison.h"
#include "roevo-compare/report/documents.h"
#include "roevo-compare/report/html_parts.h"

namespace roevo {

void writeComparison(const std::string& folder, const std::vector<SequenceComparison>& sequences,
                     const ComparisonInfo& info, const std::vector<SequenceComparison>& baseline) {
    const auto results = evaluateAll(sequences);
    const auto file = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
    // All are made before the first is written, so that an interrupt does not leave new ones and old ones
    PageFiles files;
    const std::string csv = csvTable(results), md = markdownTables(results, info),
                      html = htmlReport(results, info, folder, files, evaluateAll(baseline));
    std::vector<std::pair<std::string, std::string>> pages;
    const auto add = [&](const std::string& from_folder, const PageFiles& beside) {
        for (const auto& [name, bytes] : beside.all())
            pages.emplace_back((std::filesystem::path(from_folder) / name).string(), bytes);
    };
    add(folder, files);
    if (results.size() > kManySequences)
        for (const SequenceResults& result : results)
            if (hasTrajectories(*result.sequence)) {
                const std::string page = pageFile(folder, *result.sequence),
                                  page_folder = std::filesystem::path(page).parent_path().string();
                PageFiles beside;
                pages.emplace_back(page, htmlReport({result}, info, page_folder, beside));
                add(page_folder, beside);
            }
    writeTextAtomically(file("table.csv"), csv);
    writeTextAtomically(file("table.md"), md);
    for (const auto& [page, text] : pages) {
        std::filesystem::create_directories(std::filesystem::path(page).parent_path());
        writeTextAtomically(page, text);
    }
    writeTextAtomically(file("report.html"), html);
}

}  // namespace roevo
