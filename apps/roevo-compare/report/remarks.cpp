#include "roevo-compare/report/remarks.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace roevo {
namespace {

// Why no run that went well has errors; nothing when one has.
std::optional<std::string> commonFault(const SequenceResults& results) {
    std::optional<std::string> fault;
    for (std::size_t i = 0; i < results.evaluated.size(); ++i) {
        if (results.evaluated[i].evaluation) return std::nullopt;
        if (results.sequence->runs[i].ok() && !fault) fault = results.evaluated[i].fault;
    }
    return fault;
}

std::optional<std::string> truthRemark(const SequenceResults& results) {
    const SequenceComparison& sequence = *results.sequence;
    if (!sequence.ground_truth_fault.empty())
        return "its ground truth could not be used: " + sequence.ground_truth_fault;
    if (sequence.reference.empty()) return "no ground truth, so no errors and no rank";
    if (const auto fault = commonFault(results))
        return "no run could be compared with its ground truth: " + *fault;
    return std::nullopt;
}

std::optional<std::string> framesRemark(const SequenceComparison& sequence) {
    std::set<std::size_t> counts;
    for (const MethodRun& run : sequence.runs)
        if (run.ok()) counts.insert(run.frames - std::min(run.rejected, run.frames));
    if (counts.size() < 2) return std::nullopt;
    return "the methods were given " + std::to_string(*counts.begin()) + " to " +
           std::to_string(*counts.rbegin()) + " frames, so their figures are not of the same frames";
}

// Sentences of several methods, those that mean the same put together.
class Gathered {
  public:
    // @param key  the same for what means the same
    void add(const std::string& key, const std::string& text, const std::string& label) {
        if (!labels_.count(key)) texts_.emplace_back(key, text);
        labels_[key].push_back(label);
    }
    // @param all  so many methods: what all say needs no names
    std::vector<std::string> sentences(std::size_t all) const {
        std::vector<std::string> lines;
        for (const auto& [key, text] : texts_) {
            std::string names;
            const auto& labels = labels_.at(key);
            if (labels.size() < all)
                for (const std::string& label : labels) names += (names.empty() ? "" : ", ") + label;
            lines.push_back(names.empty() ? text : names + ": " + text);
        }
        return lines;
    }

  private:
    std::vector<std::pair<std::string, std::string>> texts_;
    std::map<std::string, std::vector<std::string>> labels_;
};

}  // namespace

std::vector<std::string> warningsOf(const MethodRun& run, const EvaluatedRun& evaluated) {
    std::vector<std::string> all = run.warnings;
    if (!evaluated.scale_warning.empty()) all.push_back(evaluated.scale_warning);
    return all;
}

std::vector<std::string> odditiesOf(const SequenceResults& results) {
    const SequenceComparison& sequence = *results.sequence;
    std::vector<std::string> lines;
    if (const auto remark = framesRemark(sequence)) lines.push_back(*remark);
    Gathered warnings;
    std::size_t good = 0;
    for (std::size_t i = 0; i < results.evaluated.size(); ++i) {
        const MethodRun& run = sequence.runs[i];
        good += run.ok();
        for (const std::string& warning : run.warnings) warnings.add(warning, warning, labelOf(run));
        // Its figures differ a little from method to method
        const std::string& scale = results.evaluated[i].scale_warning;
        if (!scale.empty()) warnings.add("scale", scale, labelOf(run));
    }
    for (const std::string& warning : warnings.sentences(good)) lines.push_back(warning);
    return lines;
}

std::vector<std::string> remarks(const std::vector<SequenceResults>& results) {
    std::vector<std::string> sentences;
    std::string parts;
    for (const SequenceResults& result : results) {
        const SequenceComparison& sequence = *result.sequence;
        const auto say = [&](const std::string& what) { sentences.push_back(sequence.name + ": " + what); };
        if (!sequence.failure.empty()) {
            say("nothing could be run on it: " + sequence.failure);
            continue;
        }
        if (const auto remark = truthRemark(result)) say(*remark);
        for (const std::string& oddity : odditiesOf(result)) say(oddity);
        if (!sequence.part.empty())
            parts += (parts.empty() ? "" : "; ") + sequence.name + ": " + sequence.part;
    }
    if (!parts.empty())
        sentences.push_back("Only parts of these recordings were run (counted from 0): " + parts + ".");
    return sentences;
}

}  // namespace roevo
