#pragma once
#include <string>
#include <vector>

namespace roevo {

/// What the runs of a table have in common, see conditionsOf().
struct Conditions {
    bool pinned = true;  ///< each run was bound to one core
    bool frames = true;  ///< all methods had the same frames of each recording
    bool config = true;  ///< ROEVO had the same options everywhere
};

/// The evaluation protocol, a sentence each, as it goes with every document.
std::vector<std::string> protocolLines(const Conditions& conditions);

/// What a single table of errors must say of it.
std::string errorProtocol(const Conditions& conditions = {});

/// What a single table of shares of frames must say of it.
std::string shareProtocol(const Conditions& conditions);

/// What a single table of times and memory must say of it.
std::string costProtocol(const Conditions& conditions);

}  // namespace roevo
