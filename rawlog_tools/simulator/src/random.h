#pragma once
/// Counter-based random numbers: a value depends only on what is hashed, so that frames can be made in any
/// order and the same seed gives the same bytes everywhere (the distributions of <random> differ between
/// libraries).

#include <cmath>
#include <cstdint>

namespace roevo::simulator {

/// Finaliser of the SplitMix64 generator (Steele, Lea, Flood 2014).
inline uint64_t mixBits(uint64_t x) {
    x += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

inline uint64_t hashOf(uint64_t a, uint64_t b, uint64_t c = 0) {
    return mixBits(mixBits(mixBits(a) ^ b) ^ c);
}

/// In [0, 1).
inline double uniformOf(uint64_t hash) {
    return static_cast<double>(hash >> 11) * 0x1.0p-53;
}
inline float uniform(uint64_t a, uint64_t b, uint64_t c = 0) {
    return static_cast<float>(hashOf(a, b, c) >> 40) * 0x1.0p-24f;
}

/// Standard normal from one hash (Box and Muller 1958).
inline double gaussianOf(uint64_t hash) {
    const double u = (static_cast<double>(hash >> 32) + 0.5) * 0x1.0p-32;
    const double v = static_cast<double>(hash & 0xffffffffULL) * 0x1.0p-32;
    return std::sqrt(-2 * std::log(u)) * std::cos(6.283185307179586 * v);
}

}  // namespace roevo::simulator
