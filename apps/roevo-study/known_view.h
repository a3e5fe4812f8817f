#pragma once
#include <cstddef>
#include <vector>

#include "study.h"

namespace roevo {

/// What the frames of a recording see, by its ground truth: a coarse grid of each depth image.
class KnownViews {
  public:
    /// Reads the recording once. Frames without a depth image, or without a true pose, see nothing.
    explicit KnownViews(const StudyInput& input);

    /// Stamps of all frames, s.
    const std::vector<double>& times() const { return times_; }

    /// Share of the points that frame `frame` sees that some frame before `before` has seen: inside its
    /// image, and at the depth that it has there (10 %). 0 where the frame sees nothing.
    double knownShare(std::size_t frame, std::size_t before) const;

  private:
    static constexpr int kColumns = 32, kRows = 24;

    struct View {
        Pose T_world_camera;
        std::vector<float> depth;  // m, kRows x kColumns, 0: none; empty: sees nothing
    };
    bool sees(const View& view, const Eigen::Vector3d& point) const;

    PinholeCamera camera_;
    std::vector<double> times_;
    std::vector<View> views_;
};

}  // namespace roevo
