#pragma once
#include <gtest/gtest.h>

#include "core/support/mapping_world.h"
#include "mapping/bundle_adjustment.h"

namespace roevo::testing {

inline constexpr double kFewMillimetres = 0.004, kThirdOfADegree = 0.3 * kDegree;

/// Keyframes that walk through the room, and their edges fused.
class BundleAdjustment : public ::testing::Test {
  protected:
    void SetUp() override { look(walkThrough(room(), 6)); }

    void look(std::vector<TestKeyframe> made) {
        made_ = std::move(made);
        truth_ = windowOf(made_);
        window_ = truth_;
        edges_ = fuse(window_, clustersByCurve(made_));
    }
    /// Poses off the truth, and edges as they are fused at those.
    void drift(unsigned seed = 1, double share = 1) {
        std::mt19937 random(seed);
        window_ = truth_;
        disturb(window_, random, share * kFewMillimetres, share * kThirdOfADegree);
        edges_ = fuse(window_, clustersByCurve(made_));
    }
    BundleAdjuster adjuster() const { return {mapping_, sensor_, mappingCamera()}; }
    struct Refined {
        int iterations = 0;
        double scale = 0;          ///< px
        std::vector<int> inliers;  ///< of each window keyframe
    };
    Refined refine(int iterations, const std::vector<RelativePrior>& priors = {}) {
        BundleAdjuster own = adjuster();
        const int moved = own.refine(window_, edges_, priors, iterations);
        return {moved, own.equations().scale, own.equations().inliers};
    }
    /// As the mapper goes about it, keyframe after keyframe: associations from drifted poses are displaced
    /// along the edges, and where an edge is bent, only those at better poses tell the truth.
    Refined fuseAndRefine(int times, int iterations) {
        Refined result;
        for (int k = 0; k < times; ++k) {
            edges_ = fuse(window_, clustersByCurve(made_));
            result = refine(iterations);
        }
        return result;
    }
    /// Single iterations do not stop at the image motion that is too small to matter.
    double refineToTheEnd(int iterations) {
        double scale = 0;
        for (int k = 0; k < iterations; ++k) scale = refine(1).scale;
        return scale;
    }
    /// Iterations until all positions are within `bound` of the truth.
    int iterationsTo(double bound, int most) {
        for (int k = 1; k <= most; ++k) {
            refine(1);
            if (positionError(window_) < bound) return k;
        }
        return most + 1;
    }

    MappingOptions mapping_;
    SensorOptions sensor_;
    std::vector<TestKeyframe> made_;
    std::vector<WindowKeyframe> truth_, window_;
    FusedEdges edges_;
};

}  // namespace roevo::testing
