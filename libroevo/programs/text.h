#pragma once
#include <cstddef>
#include <optional>
#include <string>

namespace roevo {

/// Valid UTF-8 on one line: control characters become spaces, bytes that are none become U+FFFD. What comes
/// from outside (names, reasons, command lines) goes through this before it gets into any table.
std::string cleanText(const std::string& text);

/// A field of a CSV row, quoted when it has to be (RFC 4180).
std::string csvField(const std::string& text);

/// Text in a cell of a Markdown table, with all that Markdown or HTML would take for markup escaped.
std::string markdownText(const std::string& text);

/// Text or the value of an attribute in HTML and SVG.
std::string htmlText(const std::string& text);

/// A number with this many decimals; a dash when there is none, or when it is not finite.
std::string shownNumber(std::optional<double> value, int decimals);

/// The shortest digits that give the same number again, and nothing when there is none or it is not finite.
std::string exactNumber(std::optional<double> value);

/// The same digits, written as "%g" does: 0.0001 and 100000, where exactNumber() says 1e-04 and 1e+05.
std::string plainNumber(double value);

/// All 17 digits that a double may need, as "%.17g" writes them.
std::string allDigits(double value);

/// A time stamp in seconds, with microseconds, as the lists of TUM's layout have it.
std::string stampText(double timestamp);

/// "1 frame", "2 frames". @param noun  in the singular
std::string counted(std::size_t count, const std::string& noun);

/// Number of characters of a text in UTF-8.
std::size_t countCharacters(const std::string& text);

/// At most this many characters, the rest an ellipsis.
std::string shortened(const std::string& text, std::size_t limit);

/// All of `text` with `from` replaced by `to`.
std::string replaceAll(std::string text, const std::string& from, const std::string& to);

/// Any bytes as text, RFC 4648, with padding.
std::string base64(const std::string& bytes);

}  // namespace roevo
