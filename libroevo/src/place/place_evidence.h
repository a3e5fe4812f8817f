#pragma once
#include "place/edge_registration.h"
#include "place/place_describer.h"

namespace roevo {

/// How sure it is that a frame shows a place.
enum class Evidence {
    kNone,        ///< contradicted, or too little
    kPlausible,   ///< to be believed only where the camera can be, and where nothing else looks like it
    kStrong,      ///< a second look that agrees is needed
    kConclusive,  ///< to be believed at once
};

/// Fewer similar points that agree are no evidence.
inline constexpr int kLeastAgreeingPoints = 15;

/// Points that look alike and edges that fit are found at other places, too, where doors or furniture repeat;
/// what differs there is what else surrounds them. Edges of one place may fit badly where one image is
/// blurred; what surrounds its points looks the same then.
Evidence evidenceOf(const Verification& points, const EdgeRegistration& edges, const Likeness& likeness);

}  // namespace roevo
