#pragma once
#include <cstdlib>
#include <filesystem>
#include <string>

namespace roevo {

/// Debian's ROS libraries write a cache of installed packages into ~/.ros as soon as a bag is made. For the
/// life of this object they write it into a temporary folder, unless the user has set ROS_HOME.
class TemporaryRosHome {
  public:
    TemporaryRosHome() {
        if (std::getenv("ROS_HOME") != nullptr) return;
        std::error_code error;
        std::string name = (std::filesystem::temp_directory_path(error) / "bag2rawlog-XXXXXX").string();
        if (error || mkdtemp(name.data()) == nullptr) return;
        folder_ = name;
        setenv("ROS_HOME", name.c_str(), 1);
    }
    ~TemporaryRosHome() {
        std::error_code ignored;
        if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
    }
    TemporaryRosHome(const TemporaryRosHome&) = delete;
    TemporaryRosHome& operator=(const TemporaryRosHome&) = delete;

  private:
    std::filesystem::path folder_;
};

}  // namespace roevo
