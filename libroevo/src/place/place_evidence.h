#pragma once
#include "place/edge_registration.h"
#include "place/place_describer.h"
#include "place/place_verifier.h"

namespace roevo {

/// How sure it is that a frame shows a place.
enum class Evidence {
    kNone,        ///< contradicted, or too little
    kWeak,        ///< worth a second look where the camera is about there anyway
    kPlausible,   ///< to be believed where the camera came little unseen, and nothing there looks like it
    kFitting,     ///< and worth a second look elsewhere
    kStrong,      ///< to be believed wherever the camera can be, and nothing there looks like it
    kConclusive,  ///< to be believed at once
};

/// Points that look alike and edges that fit are found at other places, too, where doors or furniture repeat;
/// what differs there is what else surrounds the points. Where a camera can be tells more than all of this:
/// what repeats does so some metres apart, or turned.
Evidence evidenceOf(const Verification& points, const EdgeRegistration& edges, const Likeness& likeness);

/// Whether a registration confirms a pose that tracking says, too. Surroundings that are not known do not
/// matter.
bool confirms(const EdgeRegistration& edges, const Likeness& likeness);

}  // namespace roevo
