#pragma once
#include <vector>

#include "roevo_simulator/simulator.h"

namespace roevo::simulator {

/// Smooth (C2) carried motion of any length along a closed loop of way-points, with a little hand tremor.
///
/// The loop p(u), q(u) (position and target) is a uniform cubic B-spline. It is travelled such that
/// (dt/du)^4 = (|p'| / speed)^4 + (|f'| / turn_rate)^4, f the viewing direction: a smooth maximum. Then
/// neither limit is ever passed, and t(u) is as smooth as the spline, without any special treatment of turns.
class CameraPath {
  public:
    /// @param loop at least 4 way-points  @param speed m/s
    CameraPath(std::vector<Waypoint> loop, PathKind kind, double speed, unsigned seed);

    /// Pose at `seconds` after the start (any real number).
    Pose pose(double seconds) const;

    /// Seconds after which the path starts over.
    double circuitTime() const;

  private:
    Waypoint at(double u, int derivative) const;
    double pace(double u) const;                     ///< dt/du
    double timeBetween(double u0, double u1) const;  ///< for short intervals
    double parameterAt(double seconds) const;

    std::vector<Waypoint> loop_;
    PathKind kind_;
    double speed_;
    unsigned seed_;
    std::vector<double> node_times_;  ///< time at which u = i / kNodesPerSegment is reached
};

}  // namespace roevo::simulator
