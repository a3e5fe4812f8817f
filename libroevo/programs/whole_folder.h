#pragma once
#include <filesystem>
#include <string>

namespace roevo {

/// A folder that is there when all is in it: until commit() it is "<folder>.part", which is removed without.
class WholeFolder {
  public:
    /// @throws std::runtime_error when something of that name exists that is no empty folder, or when it
    /// cannot be made
    explicit WholeFolder(const std::string& folder);
    ~WholeFolder();
    WholeFolder(const WholeFolder&) = delete;
    WholeFolder& operator=(const WholeFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return temporary_ / name; }
    /// @throws std::runtime_error when it cannot be made
    void makeFolder(const std::string& name) const;
    /// @throws std::runtime_error when the file cannot be written
    void write(const std::string& name, const std::string& text) const;
    /// @throws std::runtime_error when it cannot get its name
    void commit();

  private:
    std::filesystem::path folder_, temporary_;
};

}  // namespace roevo
