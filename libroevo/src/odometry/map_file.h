#pragma once
#include <iosfwd>

#include "stored_map.h"

namespace roevo {

/// Writes a map, see docs/formats.md. Whether all was written is in the stream's state.
/// @throws std::runtime_error where faultOf() the map, which could not be read
void writeMap(StoredMap map, std::ostream& out);

/// @throws std::runtime_error that says in one line what is wrong: this is no map, of another version,
/// incomplete, damaged, or has what no map can have
StoredMap readMap(std::istream& in);

}  // namespace roevo
