#include <filesystem>

#include "programs/atomic_file.h"
#include "roevo-compare/report/comparison.h"
#include "roevo-compare/report/documents.h"

namespace roevo {

void writeComparison(const std::string& folder, const std::vector<SequenceComparison>& sequences,
                     const ComparisonInfo& info) {
    const auto results = evaluateAll(sequences);
    const auto file = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
    // All are made before the first is written, so that an interrupt does not leave two new ones and an old
    // one
    const std::string csv = csvTable(results), md = markdownTables(results, info),
                      html = htmlReport(results, info, folder);
    writeTextAtomically(file("table.csv"), csv);
    writeTextAtomically(file("table.md"), md);
    writeTextAtomically(file("report.html"), html);
}

}  // namespace roevo
