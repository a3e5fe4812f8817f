#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "roevo/types.h"

namespace roevo {

class PriorTerm;
struct PoseSystem;

inline constexpr double kNothingKnown = 1;  ///< m and rad: sigma of a pose that nothing tells of

/// What one edge does to a pose: by how much that would move if the edge were left out.
struct EdgeInfluence {
    std::int32_t cluster = 0;  ///< see Keyframe::clusters
    Vector6d moved = Vector6d::Zero();
};

/// What is not known of a pose: `independent`, and what edges do to it. The same edge in the scene errs alike
/// in all keyframes that see it, so that influences of one cluster add up before they are squared.
struct PoseUncertainty {
    Matrix6d independent = Matrix6d::Zero();
    std::vector<EdgeInfluence> influences;  ///< in the order of clusters, each once
    /// What frames have wrong as their neighbours do, like a read-out time: no mean makes it less.
    Matrix6d common = Matrix6d::Zero();

    Matrix6d covariance() const { return own() + common; }
    Matrix6d own() const;  ///< covariance without what is common
    /// How many errors count as one: own() over what is independent of it, mean of all directions.
    double designEffect() const;
};

/// Errors of two poses, or of one in two steps, come together: those of one edge are added before anything is
/// squared.
/// @param carried  what errors of the first do to the whole
PoseUncertainty sum(const PoseUncertainty& first, const Matrix6d& carried, const PoseUncertainty& second);

/// What each edge adds to the normal equations of a pose. The points of an edge err together (its depth in
/// the keyframe, its association, the lens), so that edges are what is independent, not their points.
class EdgeClusters {
  public:
    /// @param cluster_of  of each edge (see Keyframe::clusters)
    void start(const std::vector<std::int32_t>& cluster_of);
    /// @param matrix,vector  as in kernels::InformationArrays, of a point (m)
    void add(std::size_t edge, const float (&matrix)[6], const float (&vector)[3],
             const Eigen::Vector3d& point);

    /// Of the pose that solves the system: as of independent points, and what the pose would move by if any
    /// one edge were left out (the jackknife over clusters, which is the sandwich estimator with its
    /// small-sample correction). With no prior, what one edge alone tells is as uncertain as if nothing were
    /// known (1 m, 1 rad). A prior keeps directions solvable that no residual sees. It is no measurement:
    /// there its errors stay in the pose, with what edges did to the frame before, and do not shrink from
    /// frame to frame.
    /// @param slope  of all residuals' pull (see meanSlope()): weights alone overstate the Hessian
    /// @param prior  that is in the system
    PoseUncertainty uncertainty(const PoseSystem& system, double slope,
                                const PriorTerm* prior = nullptr) const;

  private:
    struct Sum {
        bool used = false;
        Matrix6d hessian = Matrix6d::Zero();  ///< upper triangle
        Vector6d gradient = Vector6d::Zero();
    };
    std::vector<std::int32_t> cluster_of_;  // of each edge; what follows is made of it
    std::vector<std::int32_t> clusters_;    // in order, each once
    std::vector<std::int32_t> slot_of_;     // of each edge: its cluster's place in clusters_
    std::vector<Sum> sums_;                 // of each cluster
};

}  // namespace roevo
