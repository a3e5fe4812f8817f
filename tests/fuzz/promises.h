#pragma once
#include <Eigen/Core>
#include <new>
#include <string>

#include "fuzz/targets.h"
#include "roevo/types.h"

namespace roevo::fuzz {

inline void require(bool kept, const std::string& promise) {
    if (!kept) throw Broken(promise);
}

inline void requireRigid(const Pose& pose) {
    const Eigen::Matrix3d& R = pose.linear();
    require(pose.isFinite() && (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-6 &&
                R.determinant() > 0,
            "a pose is no rigid motion");
}

/// Runs a reader, which may refuse its input in one line, or find that there is no memory for it.
/// @return whether it took it
template <class Read>
bool accepted(const Read& read) {
    try {
        read();
        return true;
    } catch (const std::runtime_error& error) {
        const std::string text = error.what();
        require(!text.empty() && text.find('\n') == std::string::npos, "an error is not one line: " + text);
        return false;
    } catch (const std::bad_alloc&) {
        return false;  // programs say so
    }
}

}  // namespace roevo::fuzz
