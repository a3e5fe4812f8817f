#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace roevo {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);

/// Values as bytes, little-endian. What writes them and what reads them have the same calls,
/// so that one function says what a format has. Values are numbers, enumerations, and pairs, arrays, vectors
/// and Eigen matrices of values; a structure's fields(), a tuple of references; or whatever a function
/// transfer(bytes, value) next to its type is for.
template <class Derived>
class ByteStream {
  public:
    template <class... Values>
    void operator()(Values&... values) {
        (transferOne(values), ...);
    }

  private:
    template <class T, class = void>
    struct HasFields : std::false_type {};
    template <class T>
    struct HasFields<T, std::void_t<decltype(std::declval<T&>().fields())>> : std::true_type {};

    Derived& self() { return static_cast<Derived&>(*this); }

    template <class T>
    void transferOne(T& value) {
        if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>)
            self().number(value);
        else if constexpr (HasFields<T>::value)
            std::apply([&](auto&... fields) { (*this)(fields...); }, value.fields());
        else
            transfer(self(), value);
    }
    template <class T>
    void transferOne(std::vector<T>& values) {
        self().list(values);
    }
    template <class T, std::size_t N>
    void transferOne(std::array<T, N>& values) {
        for (T& value : values) transferOne(value);
    }
    template <class A, class B>
    void transferOne(std::pair<A, B>& pair) {
        (*this)(pair.first, pair.second);
    }
    template <class Scalar, int Rows, int Columns>
    void transferOne(Eigen::Matrix<Scalar, Rows, Columns>& matrix) {
        static_assert(Rows > 0 && Columns > 0);
        for (Scalar& value : matrix.reshaped()) transferOne(value);
    }
};

class ByteWriter : public ByteStream<ByteWriter> {
  public:
    const std::string& bytes() const { return bytes_; }

  private:
    friend ByteStream<ByteWriter>;

    template <class T>
    void number(const T& value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    template <class T>
    void list(std::vector<T>& values) {
        auto count = static_cast<std::uint32_t>(values.size());
        (*this)(count);
        for (T& value : values) (*this)(value);
    }

    std::string bytes_;
};

/// @throws std::runtime_error, from every call, where the bytes come to their end
class ByteReader : public ByteStream<ByteReader> {
  public:
    explicit ByteReader(std::string_view bytes) : left_(bytes) {}
    bool atEnd() const { return left_.empty(); }

  private:
    friend ByteStream<ByteReader>;

    template <class T>
    void number(T& value) {
        if (left_.size() < sizeof value) throw std::runtime_error("it ends too early");
        std::memcpy(&value, left_.data(), sizeof value);
        left_.remove_prefix(sizeof value);
    }
    /// Grows with what is read: a count that is wrong ends with the bytes, and not with the memory.
    template <class T>
    void list(std::vector<T>& values) {
        std::uint32_t count = 0;
        (*this)(count);
        values.clear();
        for (std::uint32_t i = 0; i < count; ++i) (*this)(values.emplace_back());
        values.shrink_to_fit();
    }

    std::string_view left_;
};

}  // namespace roevo
