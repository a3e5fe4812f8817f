#include "baked_light.h"

namespace roevo::simulator {

BakedLight::BakedLight(const Scene&, int) {}

BakedLight::Shares BakedLight::at(int, const FacePoint&) const {
    return {1, 1, 1, 1};
}

}  // namespace roevo::simulator
