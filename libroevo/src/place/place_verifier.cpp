#include "place/place_verifier.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "indexing.h"
#include "place/place_matches.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr double kPlaceNoise = 0.015;  ///< m, one sigma: the same corner is not found at the same point again
constexpr double kMostSigmas = 2.5;    ///< of an inlier
constexpr double kMostTurn = 30 * kDegree;  ///< between the turn of a normal and the roll of the pose
constexpr double kLeastBase = 0.15;         ///< m, between the points of a sample
constexpr double kLeastSine = 0.2;          ///< of the angle between the sides of a sample
constexpr int kMostSamples = 6000;          ///< most of which fail at once
constexpr double kMissedSample = 1e-3;      ///< probability that no sample was all right, at which to stop
constexpr int kRefinements = 4;
constexpr int kLeastInliers = 8;
constexpr double kLeastExtent = 0.05;  ///< m

/// Similar points of both.
struct PointPair {
    Eigen::Vector3d query, candidate;  ///< positions in their own frames, m
    double turn;                       ///< of the normal from query to candidate in the image, rad
    double information;                ///< 1/m^2, of their distance
};
using PointPairs = std::vector<PointPair>;  ///< the most similar ones first

double angleBetween(double a, double b) {
    return std::abs(std::remainder(a - b, 2 * kPi));
}

/// Orthonormal axes of a triangle; its corners are not on a line.
Eigen::Matrix3d axesOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    Eigen::Matrix3d axes;
    axes.col(0) = (b - a).normalized();
    axes.col(2) = axes.col(0).cross(c - a).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return axes;
}

bool isSlim(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    const Eigen::Vector3d ab = b - a, ac = c - a;
    return ab.cross(ac).norm() < kLeastSine * ab.norm() * ac.norm();
}

PointPairs pairsOf(const PlacePoints& query, const PlacePoints& candidate, const SensorOptions& sensor) {
    PointPairs pairs;
    for (const PlaceMatch& match : matchPlaces(query, candidate)) {
        const PlacePoint &q = at(query, match.query), &c = at(candidate, match.candidate);
        const double of_query = sensor.depthSigma(q.z), of_candidate = sensor.depthSigma(c.z);
        const double variance = of_query * of_query + of_candidate * of_candidate + kPlaceNoise * kPlaceNoise;
        pairs.push_back({{q.x, q.y, q.z},
                         {c.x, c.y, c.z},
                         static_cast<double>(c.normal_angle) - q.normal_angle,
                         1 / variance});
    }
    return pairs;
}

bool explains(const Pose& T, double roll, const PointPair& pair) {
    return (T * pair.query - pair.candidate).squaredNorm() * pair.information < kMostSigmas * kMostSigmas &&
           angleBetween(pair.turn, roll) < kMostTurn;
}

int countInliers(const PointPairs& pairs, const Pose& T) {
    const double roll = rollOf(T);
    return static_cast<int>(std::count_if(pairs.begin(), pairs.end(),
                                          [&](const PointPair& pair) { return explains(T, roll, pair); }));
}

bool mayBeOfOnePose(const PointPair& a, const PointPair& b) {
    const double in_query = (a.query - b.query).norm(), in_candidate = (a.candidate - b.candidate).norm();
    const double variance = 1 / a.information + 1 / b.information, difference = in_query - in_candidate;
    return std::min(in_query, in_candidate) > kLeastBase &&
           difference * difference < kMostSigmas * kMostSigmas * variance &&
           angleBetween(a.turn, b.turn) < kMostTurn;
}

Pose sample(const PointPairs& pairs, std::uint32_t seed, int& best_inliers) {
    std::mt19937 random(seed);
    const auto count = static_cast<std::uint32_t>(pairs.size());
    // Similar pairs come first and are more often right: they are drawn more often
    const auto draw = [&]() -> const PointPair& {
        const auto one = static_cast<std::uint32_t>(random()) % count,
                   other = static_cast<std::uint32_t>(random()) % count;
        return pairs[std::min(one, other)];
    };
    Pose best;
    best_inliers = 0;
    int enough = kMostSamples;
    for (int k = 0; k < enough; ++k) {
        const PointPair &a = draw(), &b = draw(), &c = draw();
        if (!mayBeOfOnePose(a, b) || !mayBeOfOnePose(a, c) || !mayBeOfOnePose(b, c)) continue;
        if (isSlim(a.query, b.query, c.query) || isSlim(a.candidate, b.candidate, c.candidate)) continue;
        const Eigen::Matrix3d rotation =
            axesOf(a.candidate, b.candidate, c.candidate) * axesOf(a.query, b.query, c.query).transpose();
        const Eigen::Vector3d translation =
            (a.candidate + b.candidate + c.candidate - rotation * (a.query + b.query + c.query)) / 3;
        const Pose pose(Eigen::Quaterniond(rotation), translation);
        const int inliers = countInliers(pairs, pose);
        if (inliers <= best_inliers) continue;
        best_inliers = inliers;
        best = pose;
        const double share = std::pow(static_cast<double>(inliers) / count, 3);
        if (share < 1) {
            const double needed = std::log(kMissedSample) / std::log1p(-share);
            enough = std::min(enough, static_cast<int>(std::ceil(std::min<double>(needed, kMostSamples))));
        } else {
            enough = 0;
        }
    }
    return best;
}

Pose refine(const PointPairs& pairs, const Pose& T) {
    const double roll = rollOf(T);
    double sum = 0;
    Eigen::Vector3d query = Eigen::Vector3d::Zero(), candidate = Eigen::Vector3d::Zero();
    for (const PointPair& pair : pairs) {
        if (!explains(T, roll, pair)) continue;
        sum += pair.information;
        query += pair.information * pair.query;
        candidate += pair.information * pair.candidate;
    }
    query /= sum;
    candidate /= sum;
    Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
    for (const PointPair& pair : pairs)
        if (explains(T, roll, pair))
            correlation += pair.information * (pair.candidate - candidate) * (pair.query - query).transpose();
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d handedness(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
    const Eigen::Matrix3d rotation = svd.matrixU() * handedness.asDiagonal() * svd.matrixV().transpose();
    return {Eigen::Quaterniond(rotation), candidate - rotation * query};
}

Verification describe(const PointPairs& pairs, const Pose& T) {
    Verification out;
    out.T_candidate_query = T;
    out.matches = static_cast<int>(pairs.size());
    const double roll = rollOf(T);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (const PointPair& pair : pairs) {
        if (!explains(T, roll, pair)) continue;
        ++out.inliers;
        mean += pair.candidate;
        moments += pair.candidate * pair.candidate.transpose();
    }
    mean /= out.inliers;
    moments = moments / out.inliers - mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments, Eigen::EigenvaluesOnly);
    out.extent = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
    return out;
}

}  // namespace

std::optional<Verification> verifyPlaces(const PlacePoints& query, int query_id, const PlacePoints& candidate,
                                         int candidate_id, const SensorOptions& sensor) {
    const PointPairs pairs = pairsOf(query, candidate, sensor);
    if (static_cast<int>(pairs.size()) < kLeastInliers) return std::nullopt;
    constexpr std::uint32_t kSpread = 2654435761U;  // ids are small numbers: their seeds shall not be
    const std::uint32_t seed = (static_cast<std::uint32_t>(query_id) * kSpread) ^
                               (static_cast<std::uint32_t>(candidate_id) + kSpread);
    int inliers = 0;
    Pose best = sample(pairs, seed, inliers);
    for (int k = 0; k < kRefinements && inliers >= 3; ++k) {
        const Pose refined = refine(pairs, best);
        const int count = countInliers(pairs, refined);
        if (count < inliers) break;
        best = refined;
        inliers = count;
    }
    if (inliers < kLeastInliers) return std::nullopt;
    const Verification result = describe(pairs, best);
    if (result.extent < kLeastExtent || !best.isFinite()) return std::nullopt;
    return result;
}

}  // namespace roevo
