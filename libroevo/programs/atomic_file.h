#pragma once
#include <fstream>
#include <functional>
#include <string>

namespace roevo {

/// An output file that appears under its name only when whole. It is written beside the target under a
/// temporary name (same extension, so that writers that go by the extension work) and renamed by commit();
/// without commit(), or when the program is interrupted, the temporary file is removed. What is there and no
/// regular file (a folder, a device, a pipe) is refused.
class AtomicFile {
  public:
    /// @throws std::runtime_error when there is something else than a regular file under that name
    explicit AtomicFile(std::string path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    const std::string& path() const { return path_; }
    const std::string& temporaryPath() const { return temporary_path_; }

    /// The temporary file as a text or binary stream, opened at the first call.
    /// @throws std::runtime_error when it cannot be created
    std::ostream& stream();

    /// Closes the temporary file: where several belong together, before the first of them gets its name.
    /// @throws std::runtime_error when something was not written
    void close();

    /// Closes and renames. @throws std::runtime_error when something was not written or the rename fails
    void commit();

  private:
    std::string path_, temporary_path_;
    std::ofstream stream_;
    int slot_ = -1;
    bool committed_ = false;
};

/// Lets `write` fill a temporary path, then renames it to `path`. For writers that want a file name.
/// @throws std::runtime_error when nothing was written or the rename fails; passes on what `write` throws
void writeAtomically(const std::string& path,
                     const std::function<void(const std::string& temporary_path)>& write);

/// Same for text that is at hand. @throws std::runtime_error
void writeTextAtomically(const std::string& path, const std::string& text);

/// A folder that was made for outputs goes again when the program fails or is interrupted before there are
/// any.
void removeIfLeftEmpty(const std::string& folder);

/// Removes the temporary files of all AtomicFile objects alive, and such folders; safe in a signal handler.
void removeTemporaryFiles() noexcept;

}  // namespace roevo
