#pragma once
#include <iterator>
#include <string>

#include "support/run_program.h"

namespace roevo::test {

/// Files and folders directly in a folder.
inline std::ptrdiff_t countEntries(const std::filesystem::path& folder) {
    return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
}

/// What a call throws, as text; "" when it does not throw.
template <class Call>
std::string errorOf(Call&& call) {
    try {
        call();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

}  // namespace roevo::test
