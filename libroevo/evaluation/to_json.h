#pragma once
#include <nlohmann/json.hpp>

#include "evaluation/evaluate.h"

namespace roevo {

/// An evaluation as JSON: `ate_m`, `rpe_per_second`, `rpe_per_frame`, number of pairs and the alignment.
/// Errors that could not be measured are null. Header only, so that the library itself does without the JSON
/// package.
inline nlohmann::ordered_json toJson(const ErrorStatistics& s) {
    if (s.count == 0) return nullptr;
    return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std},
            {"min", s.min},   {"max", s.max},   {"count", s.count}};
}

inline nlohmann::ordered_json toJson(const RelativeError& e) {
    return {{"translation_m", toJson(e.translation)}, {"rotation_deg", toJson(e.rotation)}};
}

inline nlohmann::ordered_json toJson(const Evaluation& e) {
    nlohmann::ordered_json json;
    json["pairs"] = e.pairs.size();
    json["ate_m"] = toJson(e.ate.translation);
    json["rpe_per_second"] = toJson(e.rpe_second);
    json["rpe_per_frame"] = toJson(e.rpe_frame);
    const Eigen::Matrix4d T = e.ate.T_reference_estimate.matrix();
    for (int row = 0; row < 4; ++row) {
        nlohmann::ordered_json values;
        for (int column = 0; column < 4; ++column) values.push_back(T(row, column));
        json["T_reference_estimate"].push_back(values);
    }
    return json;
}

}  // namespace roevo
