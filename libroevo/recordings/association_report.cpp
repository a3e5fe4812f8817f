#include "recordings/association_report.h"

#include <cstdio>

#include "programs/text.h"

namespace roevo {

std::string AssociationReport::toText() const {
    char text[256];
    std::snprintf(text, sizeof text,
                  "%s matched, %zu colour and %zu depth images dropped, %s, largest time difference %.1f ms, "
                  "largest gap %.3f s",
                  counted(matched, "frame").c_str(), dropped_colour, dropped_depth,
                  (counted(duplicates, "repeated stamp") + (duplicates > 0 ? " left out" : "")).c_str(),
                  1e3 * largest_difference, largest_gap);
    std::string line = text;
    if (out_of_order > 0) line += ", list entries out of order: " + std::to_string(out_of_order);
    return line;
}

}  // namespace roevo
