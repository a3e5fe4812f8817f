#pragma once
#include <istream>

namespace roevo {

/// Moves on to what follows the mark that some editors put at the head of a UTF-8 text. Call it on a file
/// that was just opened.
inline void skipByteOrderMark(std::istream& in) {
    // No text begins with its first byte but for it. Nothing is put back: a pipe could not.
    if (in.peek() == 0xEF) in.ignore(3);
    if (in.eof()) in.clear();
}

}  // namespace roevo
