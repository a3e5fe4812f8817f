#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "coarse_points.h"
#include "evaluation/evaluate.h"

namespace roevo {

inline constexpr std::size_t kAblationVariants = std::size(kAllCoarsePoints);

/// The ways in which a recording is tracked.
enum AblationPass : std::size_t { kForward, kEven, kOdd, kBackward, kAblationPasses };
inline constexpr const char* kAblationPassNames[] = {"forward", "even frames", "odd frames", "backwards"};

/// Relative pose errors of several stretches taken together: every pair of poses counts the same.
class PooledErrors {
  public:
    void add(const Evaluation& evaluation);
    void add(const PooledErrors& other);

    std::optional<double> metresPerSecond() const { return rmse(second_t_, seconds_); }
    std::optional<double> degPerSecond() const { return rmse(second_r_, seconds_); }
    std::optional<double> metresPerFrame() const { return rmse(frame_t_, frames_); }
    std::optional<double> degPerFrame() const { return rmse(frame_r_, frames_); }
    std::size_t pairsOverSecond() const { return seconds_; }
    std::size_t pairsOverFrame() const { return frames_; }

  private:
    static std::optional<double> rmse(double sum, std::size_t count);

    double second_t_ = 0, second_r_ = 0, frame_t_ = 0, frame_r_ = 0;  // sums of squares: m, deg
    std::size_t seconds_ = 0, frames_ = 0;                            // pairs of poses
};

/// Tracking with one kind of points.
struct VariantRun {
    std::size_t frames = 0, tracked = 0;  ///< tracked: their motion was measured, or the first one's
    double points = 0, keyframes = 0;     ///< points aligned, summed over the keyframes
    PooledErrors errors;                  ///< empty where `fault` tells why

    std::string fault;
};

/// One stretch of frames that all kinds of points were tried on.
struct AblationPiece {
    AblationPass pass = kForward;
    std::array<VariantRun, kAblationVariants> runs;

    /// Whether any of them has errors. Else there is nothing to compare, and it is nobody's fault.
    bool judged() const;
    /// Measured the motion of most frames (kCompleteShare) and has as many errors as the best of them.
    bool finished(std::size_t variant) const;
    bool finishedByAll() const;
};

/// Pieces taken together. Errors are of those only that all kinds of points finished: one that loses its way
/// on a hard piece must not be judged by the easy ones. The other figures are of all pieces.
struct PooledPieces {
    std::size_t judged = 0, compared = 0;  ///< pieces with errors; of them, those that all finished
    std::array<std::size_t, kAblationVariants> failed{};  ///< of those judged, not finished by each
    std::array<VariantRun, kAblationVariants> variants;

    /// "raw Canny 2, DSO's selection 1": who left how many pieces unfinished; empty when nobody did.
    std::string failures() const;
};
/// @param pass  only pieces of this one; none: all
PooledPieces poolPieces(const std::vector<AblationPiece>& pieces,
                        std::optional<AblationPass> pass = std::nullopt);

}  // namespace roevo
