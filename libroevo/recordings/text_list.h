#pragma once
/// The text lists of RGB-D datasets: one entry a line, "timestamp filename …", '#' comments, any line ending.

#include <algorithm>
#include <string>
#include <vector>

#include "recordings/association_report.h"

namespace roevo {

struct TextLine {
    int number = 0;  ///< counted from 1
    std::vector<std::string> words;
};

/// Lines with something on them, split at blanks (at commas where one follows the first word); comments
/// (whole lines or at a line's end), blank lines and carriage returns are dropped.
/// @throws std::runtime_error when the file cannot be read.
std::vector<TextLine> readTextLines(const std::string& file);

/// readTextLines() without a first line that names the columns: there is no digit in it, and more follow.
std::vector<TextLine> readTable(const std::string& file);

/// The comment lines ('#') at the head of a file, or "" when there are none or no file.
std::string readHeaderComments(const std::string& file);

/// A finite number that fills the whole word. @throws std::runtime_error naming `where`.
double parseNumber(const std::string& word, const std::string& where);

/// All numbers of a text file, which must be `count`. @param what  they are, for the error: "a 4x4 matrix"
/// @throws std::runtime_error naming the file
std::vector<double> readNumbers(const std::string& file, std::size_t count, const std::string& what);

/// The word, when it can be a file's name: printable, and no longer than names are.
/// @throws std::runtime_error naming `where`.
const std::string& parseFileName(const std::string& word, const std::string& where);

struct ListEntry {
    double timestamp = 0;  ///< s, once its unit is known
    std::string file;      ///< as written
};

/// Brings entries (of any type with a `timestamp`) into ascending order of time and keeps the first of
/// several with one stamp; `report` counts both.
template <class Entry>
void sortByTime(std::vector<Entry>& entries, AssociationReport& report) {
    for (std::size_t i = 1; i < entries.size(); i++)
        if (entries[i].timestamp < entries[i - 1].timestamp) report.out_of_order++;
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.timestamp < b.timestamp; });
    const auto last = std::unique(entries.begin(), entries.end(),
                                  [](const Entry& a, const Entry& b) { return a.timestamp == b.timestamp; });
    report.duplicates += static_cast<std::size_t>(entries.end() - last);
    entries.erase(last, entries.end());
}

/// "timestamp filename" lines, stamps as they are written.
/// @throws std::runtime_error with file and line number for a malformed line.
std::vector<ListEntry> readStampedList(const std::string& file);

}  // namespace roevo
