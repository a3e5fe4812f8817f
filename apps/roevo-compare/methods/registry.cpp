#include <stdexcept>

#include "families.h"

namespace roevo {

std::vector<MethodInfo> knownMethods() {
    std::vector<MethodInfo> all;  // in the order of the tables
    for (const auto family :
         {roevoMethods, distanceFieldMethods, difodoMethods, icpMethods, opencvRgbdMethods})
        for (MethodInfo& info : family()) all.push_back(std::move(info));
    return all;
}

std::unique_ptr<Method> makeMethod(const std::string& name, const PinholeCamera& camera,
                                   const OdometryOptions& options) {
    for (const MethodInfo& info : knownMethods()) {
        if (info.name != name) continue;
        if (!info.unavailable.empty())
            throw std::invalid_argument("method '" + name + "' is not available: " + info.unavailable);
        return info.make(camera, options);
    }
    throw std::invalid_argument("there is no method called '" + name + "'");
}

}  // namespace roevo
