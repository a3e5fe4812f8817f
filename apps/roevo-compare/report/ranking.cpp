#include "roevo-compare/report/ranking.h"

#include <algorithm>
#include <utility>

namespace roevo {

std::vector<std::optional<int>> rankRuns(const Metric& metric, const SequenceResults& results,
                                         const std::vector<bool>& takes_part) {
    using Key = std::pair<bool, double>;  // incomplete runs compare greater
    std::vector<std::optional<Key>> keys(results.evaluated.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto value = metricOf(metric, results, i);
        if (takes_part[i] && value) keys[i] = Key(!isComplete(results.sequence->runs[i]), *value);
    }
    std::vector<std::optional<int>> ranks(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i)
        if (keys[i])
            ranks[i] = 1 + static_cast<int>(std::count_if(keys.begin(), keys.end(), [&](const auto& other) {
                           return other && *other < *keys[i];
                       }));
    return ranks;
}

std::vector<RankRow> rankTable(const Metric& metric, const std::vector<SequenceResults>& results,
                               const std::vector<TableMethod>& methods) {
    std::vector<RankRow> rows;
    for (const TableMethod& method : methods) rows.push_back({method, {}, 0, 0, 0});
    for (const SequenceResults& result : results) {
        const auto& runs = result.sequence->runs;
        std::vector<bool> takes_part(runs.size(), false);
        for (const TableMethod& method : methods)
            if (const auto i = findRun(*result.sequence, method.name))
                takes_part[*i] = runs[*i].skipped.empty();
        const auto ranks = rankRuns(metric, result, takes_part);
        const auto ranked =
            std::count_if(ranks.begin(), ranks.end(), [](const auto& r) { return r.has_value(); });
        if (ranked == 0) continue;  // nothing to rank by, e.g. no ground truth
        for (RankRow& row : rows) {
            const auto i = findRun(*result.sequence, row.method.name);
            if (!i || !takes_part[*i]) continue;
            const int rank = ranks[*i].value_or(static_cast<int>(ranked) + 1);
            ++row.sequences;
            row.mean_rank += rank;
            if (!ranks[*i])
                ++row.failures;
            else
                for (int k = 0; k < 3; ++k) row.top[static_cast<std::size_t>(k)] += rank <= k + 1;
        }
    }
    for (RankRow& row : rows)
        if (row.sequences > 0) row.mean_rank /= row.sequences;
    return rows;
}

bool isOurs(const std::string& method) {
    return method.rfind("roevo", 0) == 0;
}

int fullnessOf(const std::string& method) {
    static const std::vector<std::string> modes{"roevo-ct", "roevo-tr", "roevo-ba"};
    const auto at = std::find(modes.begin(), modes.end(), method.substr(0, method.find(kVariantMark)));
    return at == modes.end() ? 0 : 1 + static_cast<int>(at - modes.begin());
}

std::vector<TableMethod> oneRoevo(const std::vector<TableMethod>& methods) {
    int fullest = 0;
    for (const TableMethod& method : methods) fullest = std::max(fullest, fullnessOf(method.name));
    std::vector<TableMethod> chosen;
    for (const TableMethod& method : methods)
        if (!isOurs(method.name) || (fullest > 0 && fullnessOf(method.name) == fullest))
            chosen.push_back(method);
    return chosen;
}

}  // namespace roevo
