#include "roevo/edge_map.h"

#include <cstdio>

namespace roevo {

const char* toString(EdgeVerdict verdict) {
    switch (verdict) {
        case EdgeVerdict::kUnconfirmed:
            return "unconfirmed";
        case EdgeVerdict::kTrue:
            return "true";
        case EdgeVerdict::kSpread:
            return "pseudo: observations disagree";
        case EdgeVerdict::kVanishing:
            return "pseudo: seen too rarely";
    }
    return "unknown";
}

const char* toString(MapRefusal::Kind kind) {
    switch (kind) {
        case MapRefusal::Kind::kFewObservations:
            return "left as it was, too few observations fit the map";
        case MapRefusal::Kind::kMovedTooFar:
            return "left as it was, bundle adjustment moved it too far";
    }
    return "unknown";
}

std::string describe(const MapRefusal& refusal) {
    char detail[64];
    if (refusal.kind == MapRefusal::Kind::kFewObservations)
        std::snprintf(detail, sizeof detail, "%d", refusal.observations);
    else
        std::snprintf(detail, sizeof detail, "%.0f mm, %.1f deg", 1000 * refusal.moved, refusal.turned);
    return std::string(toString(refusal.kind)) + ": keyframe " + std::to_string(refusal.keyframe) + " (" +
           detail + ")";
}

}  // namespace roevo
