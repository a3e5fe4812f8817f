#pragma once
#include <map>
#include <string>
#include <vector>

namespace roevo::test {

/// Records of a CSV text (RFC 4180) with a head: field by column name. A record with another number of fields
/// than the head gets the field "" = "broken".
inline std::vector<std::map<std::string, std::string>> parseCsv(const std::string& text) {
    std::vector<std::vector<std::string>> records;
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
            fields.back() += c;
            ++i;
        } else if (c == '"') {
            quoted = !quoted;
        } else if (c == ',' && !quoted) {
            fields.emplace_back();
        } else if (c == '\n' && !quoted) {
            records.push_back(fields);
            fields.assign(1, "");
        } else {
            fields.back() += c;
        }
    }
    std::vector<std::map<std::string, std::string>> rows;
    for (std::size_t r = 1; r < records.size(); ++r) {
        std::map<std::string, std::string> row;
        for (std::size_t c = 0; c < std::min(records[0].size(), records[r].size()); ++c)
            row[records[0][c]] = records[r][c];
        if (records[r].size() != records[0].size() || row.size() != records[0].size()) row[""] = "broken";
        rows.push_back(row);
    }
    return rows;
}

}  // namespace roevo::test
