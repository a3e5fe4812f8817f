#include "ablation_pieces.h"

#include <algorithm>
#include <cmath>

#include "roevo-compare/report/results.h"

namespace roevo {

void PooledErrors::add(const Evaluation& evaluation) {
    const auto squares = [](const ErrorStatistics& errors) {
        return static_cast<double>(errors.count) * std::pow(errors.rmse, 2);
    };
    if (evaluation.rpe_second.translation.count > 0) {
        second_t_ += squares(evaluation.rpe_second.translation);
        second_r_ += squares(evaluation.rpe_second.rotation);
        seconds_ += evaluation.rpe_second.translation.count;
    }
    if (evaluation.rpe_frame.translation.count > 0) {
        frame_t_ += squares(evaluation.rpe_frame.translation);
        frame_r_ += squares(evaluation.rpe_frame.rotation);
        frames_ += evaluation.rpe_frame.translation.count;
    }
}

void PooledErrors::add(const PooledErrors& other) {
    second_t_ += other.second_t_;
    second_r_ += other.second_r_;
    frame_t_ += other.frame_t_;
    frame_r_ += other.frame_r_;
    seconds_ += other.seconds_;
    frames_ += other.frames_;
}

std::optional<double> PooledErrors::rmse(double sum, std::size_t count) {
    if (count == 0) return std::nullopt;
    return std::sqrt(sum / static_cast<double>(count));
}

bool AblationPiece::judged() const {
    return std::any_of(runs.begin(), runs.end(),
                       [](const VariantRun& run) { return run.errors.pairsOverFrame() > 0; });
}

bool AblationPiece::finished(std::size_t variant) const {
    const VariantRun& run = runs[variant];
    if (static_cast<double>(run.tracked) < kCompleteShare * static_cast<double>(run.frames)) return false;
    return std::all_of(runs.begin(), runs.end(), [&](const VariantRun& other) {
        return run.errors.pairsOverFrame() >= other.errors.pairsOverFrame() &&
               run.errors.pairsOverSecond() >= other.errors.pairsOverSecond();
    });
}

bool AblationPiece::finishedByAll() const {
    for (std::size_t v = 0; v < kAblationVariants; ++v)
        if (!finished(v)) return false;
    return true;
}

std::string PooledPieces::failures() const {
    std::string text;
    for (std::size_t v = 0; v < kAblationVariants; ++v)
        if (failed[v] > 0)
            text += (text.empty() ? "" : ", ") + std::string(label(kAllCoarsePoints[v])) + ' ' +
                    std::to_string(failed[v]);
    return text;
}

PooledPieces poolPieces(const std::vector<AblationPiece>& pieces, std::optional<AblationPass> pass) {
    PooledPieces pooled;
    for (const AblationPiece& piece : pieces) {
        if (pass && piece.pass != *pass) continue;
        const bool compared = piece.judged() && piece.finishedByAll();
        pooled.judged += piece.judged();
        pooled.compared += compared;
        for (std::size_t v = 0; v < kAblationVariants; ++v) {
            const VariantRun& run = piece.runs[v];
            VariantRun& sum = pooled.variants[v];
            sum.frames += run.frames;
            sum.tracked += run.tracked;
            sum.points += run.points;
            sum.keyframes += run.keyframes;
            if (sum.fault.empty()) sum.fault = run.fault;
            pooled.failed[v] += piece.judged() && !piece.finished(v);
            if (compared) sum.errors.add(run.errors);
        }
    }
    return pooled;
}

}  // namespace roevo
