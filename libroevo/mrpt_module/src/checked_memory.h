#pragma once
#include <cstddef>

namespace roevo {

/// Largest block of memory that MRPT's containers may ask for, bytes: a range image of 16384 x 16384 pixels.
inline constexpr std::size_t kLargestMrptBlock = std::size_t{512} << 20;

/// MRPT makes room for as many pixels as a rawlog's header promises before it reads them, and takes the null
/// that its own aligned_malloc() returns where there is no such room for memory: a damaged header ended the
/// program. With roevo_mrpt come functions of the same names, which programs take before those of a shared
/// library: they throw std::length_error beyond kLargestMrptBlock, and std::bad_alloc where memory has run
/// out. So does the operator that reads a text, which made room for 4 GB where a damaged length said so: it
/// takes no more than the file holds. Calling this makes the linker take them.
void useCheckedMrptMemory();

/// For calls of libraries that end the program by themselves where memory runs out.
/// @throws std::bad_alloc when a limit on the address space (ulimit -v) leaves less than that
void requireRoom(std::size_t bytes);

}  // namespace roevo
