#pragma once
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace roevo {

/// The results of one run, which get their names in their folder together, when all are written. Until then
/// they are in a folder of their own in there, which is removed without commit(); what an earlier run has
/// left is kept so long.
class WholeOutputs {
  public:
    /// @param names  of all files that the run may write
    /// @throws std::runtime_error when something else than a regular file has one of these names
    WholeOutputs(const std::string& folder, std::vector<std::string> names);
    ~WholeOutputs();
    WholeOutputs(const WholeOutputs&) = delete;
    WholeOutputs& operator=(const WholeOutputs&) = delete;

    /// Where to write one of them. @throws std::runtime_error when there is no place for it
    std::string path(const std::string& name);

    /// Gives those that were asked for their names; the others, of an earlier run, are removed.
    /// @throws std::runtime_error
    void commit();

  private:
    void checkNames() const;

    std::filesystem::path folder_, temporary_;
    std::vector<std::string> names_;
    std::set<std::string> written_;
};

}  // namespace roevo
