#include "roevo_mrpt/config_file.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <variant>

#include "input/excerpt.h"
#include "input/regular_file.h"
#include "whole_file.h"

namespace roevo {
namespace {

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos) return "";
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string withoutComment(const std::string& line) {
    const auto start = std::min({line.find(';'), line.find('#'), line.find("//")});
    return trimmed(line.substr(0, start));
}

std::string number(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
}

/// "description, unit, min to max"
std::string explanation(const OptionField& field) {
    std::string text = field.description;
    if (!field.unit.empty()) text += ", " + field.unit;
    if (std::holds_alternative<bool*>(field.value))
        text += ", true or false";
    else if (field.max > field.min)
        text += ", " + number(field.min) + " to " + number(field.max);
    return text;
}

}  // namespace

void loadConfigText(const std::string& text, const std::string& name, OdometryOptions& options) {
    OdometryOptions changed = options;
    std::istringstream in(text);
    std::string line, section;
    std::map<std::string, int> lines;  // that options stand in
    for (int line_number = 1; std::getline(in, line); line_number++) {
        if (line_number == 1 && line.rfind("\xEF\xBB\xBF", 0) == 0)
            line.erase(0, 3);  // as editors on Windows write
        const std::string content = withoutComment(line);
        if (content.empty()) continue;
        const std::string where = name + ":" + std::to_string(line_number) + ": ";
        if (content.front() == '[' && content.back() == ']') {
            section = trimmed(content.substr(1, content.size() - 2));
            continue;
        }
        const auto equals = content.find('=');
        if (equals == std::string::npos)
            throw std::runtime_error(where + "expected 'key = value', found '" + excerpt(content) + "'");
        const std::string key = trimmed(content.substr(0, equals)),
                          value = trimmed(content.substr(equals + 1));
        const std::string option = section.empty() ? key : section + "." + key;
        const std::string fault = setOption(changed, option, value);
        if (!fault.empty()) throw std::runtime_error(where + fault);
        if (const auto [before, fresh] = lines.emplace(option, line_number); !fresh)
            throw std::runtime_error(where + option + " stands here again, first in line " +
                                     std::to_string(before->second));
    }
    if (const std::string fault = checkOptions(changed); !fault.empty())
        throw std::runtime_error(name + ": " + fault);
    options = changed;
}

void loadConfigFile(const std::string& file, OdometryOptions& options) {
    requireRegularInput(file);
    std::ifstream in(file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!in.is_open() || in.bad()) throw std::runtime_error("cannot read config file " + file);
    loadConfigText(text, file, options);
}

std::string toConfigText(const OdometryOptions& options) {
    OdometryOptions copy = options;
    std::string text, section;
    for (const OptionField& field : optionFields(copy)) {
        if (field.section != section) {
            text += std::string(section.empty() ? "" : "\n") + "[" + field.section + "]\n";
            section = field.section;
        }
        text += "; " + explanation(field) + "\n" + field.key + " = " + field.toText() + "\n";
    }
    return text;
}

void saveConfigFile(const std::string& file, const OdometryOptions& options) {
    writeWholeFile(file, [&](const std::string& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out << toConfigText(options);
        out.close();
        return !out.fail();
    });
}

}  // namespace roevo
