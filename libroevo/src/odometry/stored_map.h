#pragma once
#include <string>
#include <vector>

#include "mapping/local_mapper.h"
#include "mapping/semi_dense.h"
#include "place/place_points.h"
#include "roevo/camera/pinhole_camera.h"
#include "trajectory.h"

namespace roevo {

/// What a file keeps of a map: keyframes of one track, with what is known of each; by their ids.
struct StoredMap {
    PinholeCamera camera;
    KeyframeGraph graph;
    std::vector<PlacePoints> places;  ///< what they are recognised by
    std::vector<KeptKeyframe> edges;
    std::vector<PackedPoints> surfaces;
};

/// Leaves out all keyframes but some, and whatever refers to them; the others get new ids, in their old
/// order.
/// @param kept  of each keyframe; the link of one that is kept is to another such
void keepOnly(const std::vector<bool>& kept, StoredMap& map);

/// Leaves out keyframes that show nothing new: older ones that stay see their edges, and one has about their
/// view. What is linked to them is linked to others that are.
/// @param first  those before it stay
void leaveOutCovered(const KeyframeOptions& due, int first, StoredMap& map);

/// What is wrong with a map, in words, else empty: numbers that are none, references to what is not there,
/// sizes that do not fit.
std::string faultOf(const StoredMap& map);

/// Size, intrinsics and, where there is one, lens.
std::string describe(const PinholeCamera& camera);

}  // namespace roevo
