#pragma once
#include <cstdint>
#include <list>
#include <string>
#include <utility>

#include "recordings/bags/decompress.h"

namespace roevo {

/// The pieces of a compressed bag that were needed last: colour and depth of a moment are mostly in the same
/// one, or in neighbours.
class ChunkCache {
  public:
    /// The piece of that number, unpacked when it is not there; valid until the next call.
    template <class Unpack>
    const std::string& get(std::uint64_t number, const Unpack& unpack) {
        for (auto chunk = chunks_.begin(); chunk != chunks_.end(); ++chunk)
            if (chunk->first == number) {
                chunks_.splice(chunks_.begin(), chunks_, chunk);
                return chunk->second;
            }
        if (chunks_.size() == kMost) chunks_.pop_back();
        chunks_.emplace_front(number, unpack());
        return chunks_.front().second;
    }

  private:
    static constexpr std::size_t kMost = 4;
    std::list<std::pair<std::uint64_t, std::string>> chunks_;
};

}  // namespace roevo
