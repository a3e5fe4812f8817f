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
        std::istringstream words(text);
        for (std::string word; words >> word && word[0] != '#';) line.words.push_back(word);
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

std::vector<ListEntry> readStampedList(const std::string& file, AssociationReport& report) {
    std::vector<ListEntry> entries;
    for (const TextLine& line : readTextLines(file)) {
        const std::string where = file + ":" + std::to_string(line.number);
        if (line.words.size() < 2) throw std::runtime_error(where + ": expected 'timestamp filename'");
        entries.push_back({parseNumber(line.words[0], where), parseFileName(line.words[1], where)});
    }
    sortByTime(entries, report);
    return entries;
}

}  // namespace roevo
