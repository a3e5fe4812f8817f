#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "roevo/options.h"
#include "tracking/fine_tracker.h"

namespace roevo {

/// Points of a keyframe that both registrations reproject and look up in every step.
inline std::size_t lookedUpPoints(const Keyframe& keyframe, const FineOptions& options) {
    const std::size_t all = keyframe.edges.size(), most = static_cast<std::size_t>(options.max_points);
    const std::size_t stride = std::max<std::size_t>(1, (all + most - 1) / most);
    return (all + stride - 1 - stride / 2) / stride;  // from the one at stride / 2 on
}

/// With so many steps allowed a registration takes every one of them: the search radius narrows down to the
/// last.
inline constexpr int kFixedSteps = 5;

/// Tells how many steps a registration took, from outside: the fewest that it must be allowed to end at the
/// very same pose. From kFixedSteps on, how many are allowed has no influence on the steps themselves.
template <class Tracker>
class StepCounter {
  public:
    /// @param make  makes a tracker of FineOptions
    template <class Make>
    StepCounter(FineOptions options, Make make) : most_(options.max_iterations) {
        for (int steps = std::min(kFixedSteps, most_); steps < most_; ++steps) {
            options.max_iterations = steps;
            limited_.push_back(std::make_unique<Tracker>(make(options)));
        }
    }

    /// @param track  runs the registration once more with the tracker that it is given
    template <class Track>
    int count(const FineResult& result, Track track) {
        std::size_t low = 0, high = limited_.size();
        while (low < high) {
            const std::size_t middle = (low + high) / 2;
            const FineResult found = track(*limited_[middle]);
            if (found.T_current_keyframe.matrix() == result.T_current_keyframe.matrix()) {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        return most_ - static_cast<int>(limited_.size() - low);
    }

  private:
    int most_;
    std::vector<std::unique_ptr<Tracker>> limited_;  // to ever more steps, all but the most
};

}  // namespace roevo
