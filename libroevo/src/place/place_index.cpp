#include "place/place_index.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "indexing.h"

namespace roevo {
namespace {

constexpr std::size_t kTables = 16, kBitsOfTable = Descriptor::kBits / kTables;
constexpr std::size_t kBucketsOfTable = std::size_t{1} << kBitsOfTable;
/// Points of a keyframe that are indexed and asked for, the first ones: all 400 found no more, with twice the
/// memory and time.
constexpr std::size_t kIndexedPoints = 200;
/// Votes of a query at most, those of small buckets first: bounds its time, whatever the keyframes look like.
constexpr std::size_t kMostVotes = 2'000'000;
/// A bucket that more than one in so many keyframes are in tells nothing, once it has some.
constexpr std::size_t kOverfull = 4, kFewKeyframes = 64;
constexpr double kVoteUnit =
    1 / 256.;  ///< of weights, which are whole numbers: sums do not depend on the order

std::size_t bucketOf(const Descriptor& descriptor, std::size_t table) {
    const std::size_t bit = table * kBitsOfTable;
    const std::uint64_t key = (descriptor.words[bit / 64] >> (bit % 64)) & (kBucketsOfTable - 1);
    return table * kBucketsOfTable + static_cast<std::size_t>(key);
}

}  // namespace

void PlaceIndex::insert(int id, const PlacePoints& points) {
    if (ids_.empty()) lists_.reset(kTables * kBucketsOfTable);
    const auto place = static_cast<std::uint32_t>(ids_.size());
    collectBuckets(points);
    for (const std::uint32_t bucket : buckets_) lists_.append(bucket, place);
    ids_.push_back(id);
    size_norm_.push_back(std::sqrt(static_cast<double>(buckets_.size()) + 1));
}

std::vector<PlaceCandidate> PlaceIndex::query(const PlacePoints& points, std::size_t max_results,
                                              const std::function<bool(int)>& wanted) {
    std::vector<PlaceCandidate> out;
    if (ids_.empty()) return out;
    collectBuckets(points);
    vote();
    for (std::size_t k = 0; k < ids_.size(); ++k)
        if (votes_[k] > 0 && wanted(ids_[k])) out.push_back({ids_[k], kVoteUnit * votes_[k] / size_norm_[k]});
    const std::size_t kept = std::min(max_results, out.size());
    std::partial_sort(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(kept), out.end(),
                      [](const PlaceCandidate& a, const PlaceCandidate& b) {
                          return a.score != b.score ? a.score > b.score : a.id < b.id;
                      });
    out.resize(kept);
    return out;
}

void PlaceIndex::collectBuckets(const PlacePoints& points) {
    buckets_.clear();
    const std::size_t count = std::min(points.size(), kIndexedPoints);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t table = 0; table < kTables; ++table)
            buckets_.push_back(static_cast<std::uint32_t>(bucketOf(points[i].descriptor, table)));
    std::sort(buckets_.begin(), buckets_.end());
    buckets_.erase(std::unique(buckets_.begin(), buckets_.end()), buckets_.end());
}

void PlaceIndex::vote() {
    votes_.assign(ids_.size(), 0);
    const std::size_t overfull = std::max(kFewKeyframes, ids_.size() / kOverfull);
    eraseIf(buckets_, [&](std::uint32_t bucket) {
        const std::size_t length = lists_.length(bucket);
        return length == 0 || length > overfull;
    });
    std::sort(buckets_.begin(), buckets_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::make_tuple(lists_.length(a), a) < std::make_tuple(lists_.length(b), b);
    });
    std::size_t left = kMostVotes;
    for (const std::uint32_t bucket : buckets_) {
        const std::size_t length = lists_.length(bucket);
        if (length > left) break;
        left -= length;
        const double rarity = std::log(1 + static_cast<double>(ids_.size()) / static_cast<double>(length));
        const auto weight = static_cast<std::uint32_t>(std::lround(rarity / kVoteUnit));
        for (const std::uint32_t* place = lists_.begin(bucket); place != lists_.end(bucket); ++place)
            votes_[*place] += weight;
    }
}

}  // namespace roevo
