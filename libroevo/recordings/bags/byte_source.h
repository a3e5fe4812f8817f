#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace roevo {

/// Bytes with an end, read at any place.
class ByteSource {
  public:
    virtual ~ByteSource() = default;
    virtual std::uint64_t size() const = 0;
    /// Valid until the next call. @throws std::runtime_error when there are not so many
    virtual std::string_view read(std::uint64_t offset, std::uint64_t count) = 0;
};

/// What has been read already.
class MemoryBytes : public ByteSource {
  public:
    explicit MemoryBytes(std::string_view bytes) : bytes_(bytes) {}
    std::uint64_t size() const override { return bytes_.size(); }
    std::string_view read(std::uint64_t offset, std::uint64_t count) override;

  private:
    std::string_view bytes_;
};

/// A file, of which small neighbouring pieces are read at once.
class FileBytes : public ByteSource {
  public:
    /// @throws std::runtime_error naming the file
    explicit FileBytes(const std::string& path);
    ~FileBytes() override;
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;

    std::uint64_t size() const override { return size_; }
    std::string_view read(std::uint64_t offset, std::uint64_t count) override;

  private:
    std::string path_;
    int file_ = -1;
    std::uint64_t size_ = 0;
    std::string buffer_;  ///< of the file from begin_ on
    std::uint64_t begin_ = 0;
};

}  // namespace roevo
