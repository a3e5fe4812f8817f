#include <stdexcept>

#include "difodo.h"
#include "distance_field_method.h"
#include "icp.h"
#include "method.h"
#include "opencv_rgbd.h"
#include "roevo_method.h"

namespace roevo {
namespace {

/// A family of methods: what it offers, and how one of them is made.
struct Family {
    std::vector<MethodInfo> (*methods)();
    std::unique_ptr<Method> (*make)(const std::string& name, const PinholeCamera& camera,
                                    const OdometryOptions& options);
};

// In the order of the tables.
constexpr Family kFamilies[] = {
    {roevoMethods, makeRoevo}, {distanceFieldMethods, makeDistanceField}, {difodoMethods, makeDifodo},
    {icpMethods, makeIcp},     {opencvRgbdMethods, makeOpencvRgbd},
};

}  // namespace

std::vector<MethodInfo> knownMethods() {
    std::vector<MethodInfo> all;
    for (const Family& family : kFamilies)
        for (const MethodInfo& info : family.methods()) all.push_back(info);
    return all;
}

std::unique_ptr<Method> makeMethod(const std::string& name, const PinholeCamera& camera,
                                   const OdometryOptions& options) {
    for (const Family& family : kFamilies)
        for (const MethodInfo& info : family.methods()) {
            if (info.name != name) continue;
            if (!info.unavailable.empty())
                throw std::invalid_argument("method '" + name + "' is not available: " + info.unavailable);
            return family.make(name, camera, options);
        }
    throw std::invalid_argument("there is no method called '" + name + "'");
}

}  // namespace roevo
