#pragma once
/// The text lists of RGB-D datasets: one entry a line, "timestamp filename …", '#' comments, any line ending.

#include <string>
#include <vector>

namespace roevo {

struct TextLine {
    int number = 0;  ///< counted from 1
    std::vector<std::string> words;
};

/// Lines with something on them, split at blanks; comments, blank lines and carriage returns are dropped.
/// @throws std::runtime_error when the file cannot be read.
std::vector<TextLine> readTextLines(const std::string& file);

/// The comment lines ('#') at the head of a file, or "" when there are none or no file.
std::string readHeaderComments(const std::string& file);

/// A finite number that fills the whole word. @throws std::runtime_error naming `where`.
double parseNumber(const std::string& word, const std::string& where);

struct ListEntry {
    double timestamp = 0;  ///< s
    std::string file;      ///< as written
};

/// "timestamp filename" lines in ascending order of time, the first of several with one stamp kept.
/// @param duplicates  increased by the number of entries left out
/// @throws std::runtime_error with file and line number for a malformed line.
std::vector<ListEntry> readStampedList(const std::string& file, std::size_t& duplicates);

}  // namespace roevo
