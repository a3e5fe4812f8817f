#pragma once
#include <istream>

namespace roevo {

/// Moves on to what follows the mark that some editors put at the head of a UTF-8 text. Call it on a file
/// that was just opened.
inline void skipByteOrderMark(std::istream& in) {
    char head[3] = {};
    if (in.read(head, 3) && head[0] == '\xEF' && head[1] == '\xBB' && head[2] == '\xBF') return;
    in.clear();
    in.seekg(0);
}

}  // namespace roevo
