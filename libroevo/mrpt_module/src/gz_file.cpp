#include "gz_file.h"

#include <mrpt/serialization/CArchive.h>

#include <array>
#include <fstream>

namespace roevo {

std::uint32_t gzTrailerLength(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::array<unsigned char, 4> b{};
    in.seekg(-4, std::ios::end);
    in.read(reinterpret_cast<char*>(b.data()), 4);
    if (!in) return 0;
    return static_cast<std::uint32_t>(b[0] | b[1] << 8 | b[2] << 16) | static_cast<std::uint32_t>(b[3]) << 24;
}

bool GzFile::open(const std::filesystem::path& file, int level) {
    file_ = file;
    return stream_.open(file.string(), level);
}

std::size_t GzFile::Write(const void* data, std::size_t count) {
    const std::size_t written = stream_.Write(data, count);
    bytes_ += written;
    return written;
}

bool GzFile::write(const mrpt::serialization::CSerializable& object) {
    try {
        mrpt::serialization::archiveFrom(*this) << object;
        return true;
    } catch (const std::exception&) {
        return false;  // MRPT's own words go over several lines
    }
}

bool GzFile::close() {
    stream_.close();
    return gzTrailerLength(file_) == static_cast<std::uint32_t>(bytes_);
}

}  // namespace roevo
