#include <filesystem>

#include "roevo-compare/report/comparison.h"
#include "roevo-compare/report/documents.h"
#include "support/atomic_file.h"

namespace roevo {

void writeComparison(const std::string& folder, const std::vector<SequenceComparison>& sequences,
                     const ComparisonInfo& info) {
    const auto results = evaluateAll(sequences);
    const auto file = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
    writeTextAtomically(file("table.csv"), csvTable(results));
    writeTextAtomically(file("table.md"), markdownTables(results, info));
    writeTextAtomically(file("report.html"), htmlReport(results, info, folder));
}

}  // namespace roevo
