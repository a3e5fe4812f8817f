#include "roevo-compare/report/remarks.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "roevo-compare/report/ranking.h"

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

std::optional<std::string> framesRemark(const SequenceComparison& sequence) {
    std::set<std::size_t> counts;
    Gathered parts;
    for (const MethodRun& run : sequence.runs)
        if (run.ok()) {
            counts.insert(run.frames - std::min(run.rejected, run.frames));
            parts.add(run.part, run.part.empty() ? "all frames" : run.part, labelOf(run));
        }
    const auto sentences = parts.sentences(sequence.runs.size());
    if (sentences.size() > 1) {
        std::string text;
        for (const std::string& sentence : sentences) text += (text.empty() ? "" : "; ") + sentence;
        return text + ": figures are not of the same frames";
    }
    if (counts.size() < 2) return std::nullopt;
    return "the methods were given " + std::to_string(*counts.begin()) + " to " +
           std::to_string(*counts.rbegin()) + " frames, so their figures are not of the same frames";
}

// By "section.key", but for the mode, which is the method's own.
std::map<std::string, std::string> optionsOf(const std::string& config) {
    std::map<std::string, std::string> options;
    std::istringstream lines(config);
    std::string section;
    for (std::string line; std::getline(lines, line);) {
        const std::size_t equals = line.find(" = ");
        if (line[0] == '[') section = line.substr(1, line.find(']') - 1) + ".";
        if (line[0] != ';' && equals != std::string::npos)
            options[section + line.substr(0, equals)] = line.substr(equals + 3);
    }
    options.erase("odometry.mode");
    return options;
}

}  // namespace

std::vector<std::string> warningsOf(const MethodRun& run, const EvaluatedRun& evaluated,
                                    const SequenceComparison& sequence,
                                    const std::optional<std::string>& options) {
    std::vector<std::string> all = run.warnings;
    if (!evaluated.scale_warning.empty()) all.push_back(evaluated.scale_warning);
    if (const auto remark = framesRemark(sequence)) all.push_back(*remark);
    if (options && isOurs(run.method)) all.push_back(*options);
    return all;
}

std::optional<std::string> optionsRemark(const std::vector<SequenceResults>& results) {
    std::map<std::string, std::set<std::string>> configs;  // by variant: those are to differ
    for (const SequenceResults& result : results)
        for (const MethodRun& run : result.sequence->runs)
            if (isOurs(run.method)) {
                const std::size_t mark = run.method.find(kVariantMark);
                configs[mark == std::string::npos ? "" : run.method.substr(mark)].insert(run.config);
            }
    std::map<std::pair<std::string, std::string>, std::set<std::string>> values;  // by variant and option
    for (const auto& [variant, texts] : configs)
        for (const std::string& text : texts)
            for (const auto& [option, value] : optionsOf(text)) values[{variant, option}].insert(value);
    std::string differing;
    for (const auto& [key, all] : values) {
        if (all.size() < 2) continue;
        std::string list;
        for (const std::string& value : all) list += (list.empty() ? "" : ", ") + value;
        differing += (differing.empty() ? "" : ", ") + key.second + key.first + " (" + list + ")";
    }
    if (differing.empty()) return std::nullopt;
    return "Runs of ROEVO differ in " + differing + ": figures are not of one configuration";
}

Conditions conditionsOf(const std::vector<SequenceResults>& results) {
    Conditions conditions;
    for (const SequenceResults& result : results) {
        conditions.frames = conditions.frames && !framesRemark(*result.sequence);
        for (const MethodRun& run : result.sequence->runs)
            conditions.pinned = conditions.pinned && run.not_pinned.empty();
    }
    conditions.config = !optionsRemark(results);
    return conditions;
}

std::string commonPart(const SequenceComparison& sequence) {
    std::set<std::string> parts;
    for (const MethodRun& run : sequence.runs)  // what failed may not know its own
        if (run.ok() || !run.part.empty()) parts.insert(run.part);
    return parts.size() == 1 ? *parts.begin() : "";
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
        if (const std::string part = commonPart(sequence); !part.empty())
            parts += (parts.empty() ? "" : "; ") + sequence.name + ": " + part;
    }
    if (const auto remark = optionsRemark(results)) sentences.push_back(*remark);
    if (!parts.empty())
        sentences.push_back("Only parts of these recordings were run (counted from 0): " + parts + ".");
    return sentences;
}

}  // namespace roevo
