#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace roevo {

/// What a piece of a bag holds. Grows with what comes out, so that a wrong size ends with the bytes and not
/// with the memory.
/// @param method  "bz2", "lz4" (frames) or "zstd"
/// @param size    that it must have
/// @throws std::runtime_error when it is damaged, of another size or compressed in another way
std::string decompressed(const std::string& method, std::string_view bytes, std::uint64_t size);

}  // namespace roevo
