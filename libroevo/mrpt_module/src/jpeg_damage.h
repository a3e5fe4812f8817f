#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace roevo {

/// Decodes all but the pixels. What is wrong with the compressed data of a JPEG file, empty when nothing is.
/// Decoders make a picture of damaged data, too: whatever its pixels happen to be.
std::string jpegDataDamage(const std::vector<std::uint8_t>& bytes);

}  // namespace roevo
