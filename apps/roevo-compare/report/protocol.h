#pragma once
#include <string>
#include <vector>

namespace roevo {

/// The evaluation protocol, a sentence each, as it goes with every document.
const std::vector<std::string>& protocolLines();

/// What a single table of errors must say of it.
std::string errorProtocol();

/// What a single table of shares of frames must say of it.
std::string shareProtocol();

/// What a single table of times and memory must say of it.
std::string costProtocol();

}  // namespace roevo
