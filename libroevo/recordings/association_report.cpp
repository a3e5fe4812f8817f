#include "recordings/association_report.h"

#include <cstdio>

namespace roevo {

std::string AssociationReport::toText() const {
    char text[256];
    std::snprintf(text, sizeof text,
                  "%zu frames matched, %zu colour and %zu depth images dropped, %zu repeated stamps, largest "
                  "time difference %.1f ms, "
                  "largest gap %.3f s",
                  matched, dropped_colour, dropped_depth, duplicates, 1e3 * largest_difference, largest_gap);
    std::string line = text;
    if (out_of_order > 0) line += ", " + std::to_string(out_of_order) + " list entries were out of order";
    return line;
}

}  // namespace roevo
