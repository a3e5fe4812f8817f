#pragma once
#include <string>
#include <vector>

namespace roevo {

/// The evaluation protocol, a sentence each, as it goes with every document.
/// @param pinned  each run was bound to one core, see allPinned()
std::vector<std::string> protocolLines(bool pinned);

/// What a single table of errors must say of it.
std::string errorProtocol();

/// What a single table of shares of frames must say of it.
std::string shareProtocol();

/// What a single table of times and memory must say of it.
std::string costProtocol(bool pinned);

}  // namespace roevo
