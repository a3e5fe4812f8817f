#include "recordings/text_list.h"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "input/excerpt.h"
#include "input/regular_file.h"
#include "programs/byte_order_mark.h"

namespace roevo {
namespace {

/// Words between blanks; between commas where the first word ends with one. What follows a '#' is none.
std::vector<std::string> splitLine(std::string text) {
    const std::size_t first = text.find_first_not_of(" \t");
    const bool csv = text.find(',') != std::string::npos && text.find(',') < text.find_first_of(" \t", first);
    if (csv) std::replace(text.begin(), text.end(), ',', ' ');
    std::vector<std::string> out;
    std::istringstream words(text);
    for (std::string word; words >> word && word[0] != '#';) {
        const bool quoted = csv && word.size() > 1 && word.front() == '"' && word.back() == '"';
        out.push_back(quoted ? word.substr(1, word.size() - 2) : word);
    }
    return out;
}

bool hasDigit(const std::string& word) {
    return word.find_first_of("0123456789") != std::string::npos;
}

}  // namespace

std::vector<TextLine> readTextLines(const std::string& file) {
    requireRegularInput(file);
    errno = 0;
    std::ifstream in(file);
    if (!in) throw std::runtime_error("cannot read " + file + ": " + std::strerror(errno ? errno : ENOENT));
    skipByteOrderMark(in);
    std::vector<TextLine> lines;
    std::string text;
    for (int number = 1; std::getline(in, text); number++) {
        TextLine line;
        line.number = number;
        line.words = splitLine(text);
        if (line.words.empty()) continue;
        lines.push_back(std::move(line));
    }
    return lines;
}

std::string readHeaderComments(const std::string& file) {
    if (!otherThanFile(file).empty()) return "";
    std::ifstream in(file);
    skipByteOrderMark(in);
    std::string comments;
    for (std::string text; std::getline(in, text) && !text.empty() && text[0] == '#';)
        comments += text + "\n";
    return comments;
}

std::vector<double> readNumbers(const std::string& file, std::size_t count, const std::string& what) {
    std::vector<double> numbers;
    for (const TextLine& line : readTextLines(file))
        for (const std::string& word : line.words)
            numbers.push_back(parseNumber(word, file + ":" + std::to_string(line.number)));
    if (numbers.size() != count)
        throw std::runtime_error(file + ": expected " + what + ", found " + std::to_string(numbers.size()) +
                                 " numbers");
    return numbers;
}

const std::string& parseFileName(const std::string& word, const std::string& where) {
    constexpr std::size_t kLongest = 1024;  // bytes; Linux takes 4095 of a whole path
    if (word.size() > kLongest || excerpt(word, kLongest) != word)
        throw std::runtime_error(where + ": '" + excerpt(word) + "' cannot be a file name");
    return word;
}

double parseNumber(const std::string& word, const std::string& where) {
    double value = 0;
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value))
        throw std::runtime_error(where + ": '" + excerpt(word) + "' is not a number");
    return value;
}

std::vector<TextLine> readTable(const std::string& file) {
    auto lines = readTextLines(file);
    if (lines.size() > 1 && std::none_of(lines[0].words.begin(), lines[0].words.end(), hasDigit))
        lines.erase(lines.begin());
    return lines;
}

std::vector<ListEntry> readStampedList(const std::string& file) {
    std::vector<ListEntry> entries;
    for (const TextLine& line : readTable(file)) {
        const std::string where = file + ":" + std::to_string(line.number);
        if (line.words.size() < 2) throw std::runtime_error(where + ": expected 'timestamp filename'");
        entries.push_back({parseNumber(line.words[0], where), parseFileName(line.words[1], where)});
    }
    return entries;
}

}  // namespace roevo
