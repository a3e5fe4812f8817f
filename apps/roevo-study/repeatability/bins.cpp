#include "repeatability/bins.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace roevo {
namespace {

constexpr double kMostBins = 20;

class Means {
  public:
    void add(const RepeatabilityRow& row) {
        ++rows_;
        for (std::size_t m = 0; m < kNumAssociationMethods; ++m) {
            if (!row.share[m]) continue;
            sum_[m] += *row.share[m];
            ++count_[m];
        }
    }
    std::size_t rows() const { return rows_; }
    std::array<std::optional<double>, kNumAssociationMethods> values() const {
        std::array<std::optional<double>, kNumAssociationMethods> means;
        for (std::size_t m = 0; m < kNumAssociationMethods; ++m)
            if (count_[m] > 0) means[m] = sum_[m] / static_cast<double>(count_[m]);
        return means;
    }

  private:
    std::size_t rows_ = 0;
    std::array<double, kNumAssociationMethods> sum_{};
    std::array<std::size_t, kNumAssociationMethods> count_{};
};

double roundWidth(double range, double least) {
    const double wanted = std::max(range / kMostBins, least);
    const double power = std::pow(10, std::floor(std::log10(wanted)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= wanted * (1 - 1e-9)) return factor * power;
    return 10 * power;
}

}  // namespace

double distanceOf(const RepeatabilityRow& row, Distance distance) {
    switch (distance) {
        case Distance::kFrames:
            return static_cast<double>(row.frame - row.reference);
        case Distance::kRotation:
            return row.rotation_deg;
        case Distance::kTranslation:
            break;
    }
    return row.translation;
}

std::vector<DistanceBin> binRows(const std::vector<RepeatabilityRow>& rows, Distance distance) {
    double farthest = 0;
    for (const RepeatabilityRow& row : rows) farthest = std::max(farthest, distanceOf(row, distance));
    const double least = distance == Distance::kFrames ? 1 : distance == Distance::kRotation ? 0.1 : 0.001;
    const double width = roundWidth(farthest, least);
    std::map<long, Means> means;
    for (const RepeatabilityRow& row : rows)
        means[std::max(0L, std::lround(std::ceil(distanceOf(row, distance) / width - 1e-9)) - 1)].add(row);
    std::vector<DistanceBin> bins;
    for (const auto& [number, mean] : means)
        bins.push_back({static_cast<double>(number) * width, static_cast<double>(number + 1) * width,
                        mean.rows(), mean.values()});
    return bins;
}

std::array<std::optional<double>, kNumAssociationMethods> meanShares(
    const std::vector<RepeatabilityRow>& rows, double from, double to) {
    Means means;
    for (const RepeatabilityRow& row : rows)
        if (const double distance = distanceOf(row, Distance::kFrames); distance >= from && distance <= to)
            means.add(row);
    return means.values();
}

}  // namespace roevo
