#pragma once
#include <cstddef>
#include <string>

namespace roevo {

/// How far a run has come.
struct Advance {
    std::size_t frames = 0;
    double share = 0;  ///< of the recording, 0 to 1
};

/// The process that makes a run keeps in its folder how far it is. A file, since it outlives the process
/// whatever ends it, and since what libraries print cannot be taken for it.
class ProgressFile {
  public:
    /// @throws std::runtime_error when it cannot be created
    explicit ProgressFile(const std::string& folder);
    ~ProgressFile();
    ProgressFile(const ProgressFile&) = delete;
    ProgressFile& operator=(const ProgressFile&) = delete;

    void write(const Advance& advance) const;

    static std::string path(const std::string& folder);

  private:
    int fd_;
};

/// As the process wrote it last; nothing done when it has not written, or the file is none of its own.
Advance readProgress(const std::string& folder);

}  // namespace roevo
