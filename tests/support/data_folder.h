#pragma once
#include <cstdlib>
#include <string>

namespace roevo::test {

/// The folder with the real clips: the environment's ROEVO_DATA_DIR, else the one that CMake was given.
inline std::string dataFolder() {
    const char* from_environment = std::getenv("ROEVO_DATA_DIR");
    return from_environment != nullptr && *from_environment != '\0' ? from_environment : ROEVO_DATA_DIR;
}

}  // namespace roevo::test
