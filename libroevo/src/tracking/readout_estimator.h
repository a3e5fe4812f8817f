#pragma once
#include <cmath>

#include "tracking/gauss_newton.h"

namespace roevo {

/// Least squares for the one number that all frames share: seconds per row. Linear, because a small read-out
/// time moves points in proportion; each frame adds what its pose leaves undetermined (Schur complement).
class ReadoutEstimator {
  public:
    /// @param sigma  of the prior about zero, seconds per row
    /// @param memory  share of the evidence that is kept from frame to frame of 30 Hz: frames tracked from
    /// one keyframe share its errors, so that many of them teach hardly more than one
    ReadoutEstimator(double sigma, double memory) : prior_(1 / (sigma * sigma)), memory_(memory) {}

    /// Begins with what was learned before, seconds per row.
    void begin(double seconds_per_row, double sigma) {
        information_ = 1 / (sigma * sigma);
        vector_ = information_ * seconds_per_row;
    }
    /// @param evidence  of one frame, with gradients as they would be at zero read-out time
    /// @param frames    of 30 Hz since the last one
    void add(const PoseSystem& evidence, double frames = 1);
    double secondsPerRow() const { return vector_ / (prior_ + information_); }
    double sigma() const { return 1 / std::sqrt(prior_ + information_); }  ///< of it
    /// What a frame would add to what is known, in proportion to it.
    double worth(const PoseSystem& evidence) const;

  private:
    double prior_, memory_, information_ = 0, vector_ = 0;
};

}  // namespace roevo
