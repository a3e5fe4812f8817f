#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace roevo {

/// How the fields of a message follow one another.
enum class Wire {
    kPacked,  ///< ROS 1, and the records of bags: little-endian, without gaps
    kCdr  ///< ROS 2: either byte order, numbers at multiples of their size, strings with a zero at the end
};

/// Fields of a message, one after the other. Nothing that the bytes say is believed before it has been
/// compared with what is left. @throws std::runtime_error from every call where the bytes come to their end
class FieldReader {
  public:
    explicit FieldReader(std::string_view bytes, Wire wire = Wire::kPacked) : bytes_(bytes), wire_(wire) {
        if (wire == Wire::kCdr) readEncapsulation();
    }

    Wire wire() const { return wire_; }
    std::size_t position() const { return at_; }  ///< bytes read, for CDR without the four of its own header
    std::size_t left() const { return bytes_.size() - at_; }

    template <class T>
    T get() {
        static_assert(std::is_arithmetic_v<T>);
        if (wire_ == Wire::kCdr) skip((sizeof(T) - at_ % sizeof(T)) % sizeof(T));
        const std::string_view raw = bytes(sizeof(T));
        unsigned char ordered[sizeof(T)];
        for (std::size_t i = 0; i < sizeof(T); ++i)
            ordered[i] = static_cast<unsigned char>(raw[swapped_ ? sizeof(T) - 1 - i : i]);
        T value;
        std::memcpy(&value, ordered, sizeof value);
        return value;
    }

    void skip(std::size_t count) { bytes(count); }

    std::string_view bytes(std::size_t count) {
        if (count > left()) throw std::runtime_error("the message ends too early");
        at_ += count;
        return bytes_.substr(at_ - count, count);
    }

    /// Bytes with their number before them.
    std::string_view blob() { return bytes(get<std::uint32_t>()); }

    std::string text() {
        std::string_view value = blob();
        if (wire_ == Wire::kCdr && !value.empty() && value.back() == '\0') value.remove_suffix(1);
        return std::string(value);
    }

    /// Numbers with their count before them.
    std::vector<double> doubles() {
        const std::size_t count = get<std::uint32_t>();
        if (count > left() / sizeof(double)) throw std::runtime_error("the message ends too early");
        std::vector<double> values(count);
        for (double& value : values) value = get<double>();
        return values;
    }

  private:
    void readEncapsulation() {
        if (bytes_.size() < 4) throw std::runtime_error("the message ends too early");
        if (bytes_[0] != 0 || (bytes_[1] != 0 && bytes_[1] != 1))
            throw std::runtime_error("its encoding is not plain CDR");
        swapped_ = bytes_[1] == 0;
        bytes_.remove_prefix(4);
    }

    std::string_view bytes_;
    Wire wire_;
    std::size_t at_ = 0;
    bool swapped_ = false;  ///< big-endian; the machines that this runs on are not
};

}  // namespace roevo
