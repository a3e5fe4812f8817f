#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "place/bucket_lists.h"
#include "place/place_points.h"

namespace roevo {

struct PlaceCandidate {
    int id = 0;        ///< of a keyframe
    double score = 0;  ///< only to be compared with those of the same query
};

/// Finds the keyframes whose points look most like those of a query: multi-index hashing, in which every
/// descriptor is in one bucket of each table, by 16 of its bits, and shares of buckets vote for keyframes,
/// each for the more the fewer keyframes are in it. Needs no vocabulary; a query's work is bounded.
class PlaceIndex {
  public:
    /// @param id  that was not inserted before
    void insert(int id, const PlacePoints& points);
    /// @param wanted  whether a keyframe of that id may be a candidate
    /// @return at most max_results, best first, of equal scores the smaller id first
    std::vector<PlaceCandidate> query(const PlacePoints& points, std::size_t max_results,
                                      const std::function<bool(int)>& wanted);

    std::size_t size() const { return ids_.size(); }  ///< keyframes
    std::size_t bytes() const { return lists_.bytes(); }

  private:
    void collectBuckets(const PlacePoints& points);
    void vote();

    BucketLists lists_;              ///< of each bucket of each table: places of keyframes in ids_
    std::vector<int> ids_;           ///< in the order of insertion
    std::vector<double> size_norm_;  ///< of each keyframe: what its votes are divided by
    std::vector<std::uint32_t> buckets_, votes_;
};

}  // namespace roevo
