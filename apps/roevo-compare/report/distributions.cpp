#include "roevo-compare/report/distributions.h"

#include <algorithm>
#include <cctype>
#include <map>

#include "evaluation/error_statistics.h"
#include "programs/text.h"
#include "roevo-compare/report/protocol.h"
#include "roevo-compare/report/ranking.h"
#include "roevo-compare/report/remarks.h"

namespace roevo {
namespace {

// Figures of all runs of a method, in the order of the recordings.
std::vector<double> valuesOf(const Metric& metric, const std::vector<SequenceResults>& results,
                             const std::string& method) {
    std::vector<double> values;
    for (const SequenceResults& result : results)
        if (const auto run = findRun(*result.sequence, method))
            if (const auto value = metricOf(metric, result, *run)) values.push_back(*value);
    return values;
}

// Numbers of frames, seconds and addresses do not make another reason.
std::string withoutNumbers(const std::string& reason) {
    std::string text;
    for (const char c : reason) {
        const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
        if (!digit)
            text += c;
        else if (text.empty() || text.back() != '#')
            text += '#';
    }
    return replaceAll(text, "#.#", "#");
}

struct Column {
    const char* head;
    std::size_t metric;
    double share;  // quantile
};
constexpr Column kColumns[] = {{"ATE, median [cm]", 0, 0.5},
                               {"25 %", 0, 0.25},
                               {"75 %", 0, 0.75},
                               {"95 %", 0, 0.95},
                               {"Largest", 0, 1},
                               {"RPE 1 s, median [cm/s]", 1, 0.5},
                               {"Tracked, 5 % [%]", 5, 0.05},
                               {"Processor time, median [ms]", 8, 0.5},
                               {"Memory, largest [MB]", 9, 1}};

}  // namespace

const TableMethod& leadingMethod(const std::vector<TableMethod>& methods) {
    return *std::max_element(methods.begin(), methods.end(), [](const TableMethod& a, const TableMethod& b) {
        return fullnessOf(a.name) < fullnessOf(b.name);
    });
}

Table distributionTable(const std::vector<SequenceResults>& results,
                        const std::vector<TableMethod>& methods) {
    const Conditions conditions = conditionsOf(results);
    Table table{"Over all recordings",
                "Method",
                {"Runs", "Without result"},
                {},
                errorProtocol(conditions) + " " + costProtocol(conditions)};
    for (const Column& column : kColumns) table.columns.push_back(column.head);
    for (const TableMethod& method : methods) {
        Table::Row row{method.label, isOurs(method.name), false, {}, {}};
        std::size_t runs = 0, failed = 0;
        for (const SequenceResults& result : results)
            if (const auto i = findRun(*result.sequence, method.name)) {
                ++runs;
                failed += !result.sequence->runs[*i].ok();
            }
        for (const std::size_t count : {runs, failed})
            row.cells.push_back({std::to_string(count), false, false, {}});
        for (const Column& column : kColumns) {
            const Metric& metric = shownMetrics()[column.metric];
            const auto values = valuesOf(metric, results, method.name);
            row.cells.push_back(
                {values.empty() ? kDash : shownNumber(percentile(values, column.share), metric.decimals),
                 false, false, values.empty() ? "no run has such a figure" : ""});
        }
        table.rows.push_back(row);
    }
    return table;
}

Table reasonTable(const std::vector<SequenceResults>& results, std::size_t most) {
    struct Group {
        std::size_t count = 0;
        std::string example, reason;
    };
    std::map<std::pair<std::string, std::string>, Group> groups;
    for (const SequenceResults& result : results)
        for (std::size_t i = 0; i < result.evaluated.size(); ++i) {
            const MethodRun& run = result.sequence->runs[i];
            const std::string reason = whyNoErrors(*result.sequence, run, result.evaluated[i]);
            if (reason.empty()) continue;
            Group& group = groups[{labelOf(run), withoutNumbers(reason)}];
            if (group.count++ == 0) group.example = result.sequence->name, group.reason = reason;
        }
    std::vector<std::pair<std::string, Group>> sorted;
    for (const auto& [key, group] : groups) sorted.emplace_back(key.first, group);
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.second.count > b.second.count; });
    Table table{"Runs without errors, by reason", "Method", {"Runs", "For example"}, {}, "", true};
    table.columns.push_back("Reason there");
    if (sorted.size() > most)
        table.protocol = "The " + std::to_string(most) + " most frequent of " +
                         std::to_string(sorted.size()) + " reasons; table.csv has all.";
    sorted.resize(std::min(sorted.size(), most));
    for (const auto& [label, group] : sorted)
        table.rows.push_back({label,
                              false,
                              false,
                              {},
                              {{std::to_string(group.count), false, false, {}},
                               {group.example, false, false, {}},
                               {group.reason, false, false, {}}}});
    return table;
}

std::vector<std::size_t> worstRecordings(const std::vector<SequenceResults>& results, std::size_t count) {
    const auto methods = tableMethods(results);
    if (methods.empty()) return {};
    const std::string leading = leadingMethod(methods).name;
    std::vector<std::pair<double, std::size_t>> errors;
    for (std::size_t s = 0; s < results.size(); ++s)
        if (const auto run = findRun(*results[s].sequence, leading))
            if (const auto value = metricOf(shownMetrics().front(), results[s], *run))
                errors.emplace_back(-*value, s);
    std::sort(errors.begin(), errors.end());
    std::vector<std::size_t> worst;
    for (std::size_t i = 0; i < std::min(count, errors.size()); ++i) worst.push_back(errors[i].second);
    return worst;
}

}  // namespace roevo
