#pragma once
#include <mrpt/io/CFileGZOutputStream.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace mrpt::serialization {
class CSerializable;
}

namespace roevo {

/// The length of the uncompressed data (modulo 2^32) as the trailer of a gz file states it; 0 without one.
std::uint32_t gzTrailerLength(const std::filesystem::path& file);

/// MRPT objects into a gz file. It counts what goes into the compressor: MRPT's stream closes without a word
/// when the disk is full.
class GzFile {
  public:
    /// @param level  of compression; 0: none, yet in the gz format
    bool open(const std::filesystem::path& file, int level);

    /// False when it could not be written, as far as that is known by now.
    bool write(const mrpt::serialization::CSerializable& object);

    /// False when not all of it got into the file.
    bool close();

    // As mrpt::serialization::archiveFrom() wants a stream
    std::size_t Write(const void* data, std::size_t count);
    std::size_t Read(void*, std::size_t) { throw std::logic_error("output stream"); }
    std::string getStreamDescription() const { return stream_.getStreamDescription(); }

  private:
    std::filesystem::path file_;
    mrpt::io::CFileGZOutputStream stream_;
    std::uint64_t bytes_ = 0;
};

}  // namespace roevo
