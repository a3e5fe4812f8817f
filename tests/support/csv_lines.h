#pragma once
#include <sstream>
#include <string>
#include <vector>

namespace roevo::test {

/// The fields of every line of a CSV text, quotes taken off; no field holds a quote or a line break.
inline std::vector<std::vector<std::string>> csvLines(const std::string& csv) {
    std::vector<std::vector<std::string>> lines;
    std::istringstream text(csv);
    for (std::string line; std::getline(text, line);) {
        auto& fields = lines.emplace_back(1);
        bool quoted = false;
        for (const char c : line) {
            if (c == '"')
                quoted = !quoted;
            else if (c == ',' && !quoted)
                fields.emplace_back();
            else
                fields.back() += c;
        }
    }
    return lines;
}

}  // namespace roevo::test
