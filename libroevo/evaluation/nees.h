#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "roevo/types.h"

namespace roevo {

/// How the poses of a ground truth err: one sigma per axis, independent from pose to pose. 0: it is exact.
struct TruthNoise {
    double position = 0;     ///< m
    double orientation = 0;  ///< rad
};

/// The error of an estimated motion beside what its covariance says. NEES is the normalised estimation error
/// squared, here over the degrees of freedom (6, 3, 3): 1 on average where the covariance is right, 4 where
/// sigmas are half of what they should be.
struct JudgedMotion {
    double nees = 0, nees_translation = 0, nees_rotation = 0;
    double error_translation = 0, error_rotation = 0;  ///< m, rad
    double sigma_translation = 0,
           sigma_rotation = 0;  ///< m, rad: roots of the traces, with the truth's noise
};

/// @param truth, estimate  T_from_to
/// @param covariance  of the estimate: position, then orientation, along the axes of the second camera
/// @return none where the covariance, with the noise of the truth, is not finite or not positive definite
std::optional<JudgedMotion> judgeMotion(const Pose& truth, const Pose& estimate, const Matrix6d& covariance,
                                        const TruthNoise& noise = {});

/// What many motions come to.
struct NeesStatistics {
    std::size_t count = 0;  ///< 0: the figures mean nothing
    double inside = 0;      ///< share of the motions inside the ellipsoid that should hold 95 % of them
    JudgedMotion mean;      ///< of the NEES; of errors and sigmas the root mean square
};
NeesStatistics neesStatistics(const std::vector<JudgedMotion>& motions);

/// Judges the motions of a run as it goes on, since the covariance between two frames is best known then.
class MotionJudge {
  public:
    /// T_from_to between two poses that were added, given by their places, as it is known by now, and its
    /// covariance.
    using Motion = std::function<std::pair<Pose, Matrix6d>(std::size_t from, std::size_t to)>;

    /// @param truth  sorted by time
    /// @param intervals  s, over which motions are judged; 0: from the first pose that has a truth
    MotionJudge(std::vector<StampedPose> truth, const TruthNoise& noise,
                const std::vector<double>& intervals);

    /// The time of the next pose, and the motions that end in it: from the pose nearest to each interval ago,
    /// within a tenth of it.
    void add(double timestamp, const Motion& motion);

    const std::vector<JudgedMotion>& motions(std::size_t interval) const { return judged_[interval].motions; }
    /// Motions whose covariance is not known, as where tracking was begun anew between.
    std::size_t unknown(std::size_t interval) const { return judged_[interval].unknown; }

  private:
    struct Judged {
        double interval = 0;  ///< s
        std::vector<JudgedMotion> motions;
        std::size_t unknown = 0;
    };
    struct Entry {
        std::size_t place = 0;  ///< among the poses that were added
        double timestamp = 0;   ///< s
        Pose truth;
    };
    const Entry* startOf(double interval) const;

    std::vector<StampedPose> truth_;
    TruthNoise noise_;
    std::vector<Judged> judged_;
    std::vector<Entry> entries_;  ///< those with a truth
    std::size_t added_ = 0;
};

}  // namespace roevo
