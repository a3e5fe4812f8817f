#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace roevo {

/// A file's bytes. @throws std::runtime_error naming the file when it is missing, unreadable or empty
std::vector<std::uint8_t> readImageFile(const std::string& file);

/// Why a PNG or JPEG file cannot be whole ("truncated after 60 bytes"), or "" when it looks whole or is of
/// another kind. The libraries that decode them write of such files to stderr by themselves, and libjpeg even
/// makes up what is missing.
std::string imageDamage(const std::vector<std::uint8_t>& bytes);

}  // namespace roevo
