#include "index.h"

#include <filesystem>

#include "programs/atomic_file.h"
#include "programs/program.h"
#include "roevo-compare/machine_info.h"
#include "roevo-compare/report/protocol.h"

namespace roevo {
namespace {

bool isPlot(const std::string& file) {
    return std::filesystem::path(file).extension() == ".svg";
}

std::string machineLines() {
    std::string text = "Machine: " + machineText() + ".";
    for (const auto& [name, version] : softwareVersions()) text += ' ' + name + ' ' + version + ';';
    text.back() = '.';
    return text + '\n';
}

std::string inputTable(const std::vector<StudyInput>& inputs, const std::vector<LeftOut>& left_out) {
    std::vector<std::vector<std::string>> rows{{"recording", "input", "camera", "ground truth"}};
    for (const StudyInput& input : inputs)
        rows.push_back({input.name, input.path,
                        std::to_string(input.camera.width) + " x " + std::to_string(input.camera.height),
                        input.ground_truth_note});
    for (const LeftOut& input : left_out) rows.push_back({"not used", input.name, "", input.reason});
    return markdownTable(rows);
}

std::string protocolText() {
    return "Protocol of errors: " + errorProtocol() +
           " RPE over 1 s: the error of the relative motion from each pose to the one nearest to 1 s later "
           "(within 0.1 s), without alignment. Over all poses that the odometry gave, those that it "
           "predicted "
           "where it had lost track, too. Options are the same for all recordings, but for those under "
           "study.\n";
}

std::string entryText(const IndexEntry& entry) {
    std::string text = "\n## " + entry.title + "\n\n";
    if (!entry.failure.empty()) return text + "Failed: " + entry.failure + "\n";
    text += entry.report.summary + "\n";
    if (!entry.report.table.empty()) text += "\n" + entry.report.table;
    for (const LeftOut& left_out : entry.report.left_out)
        text += "\n- " + left_out.name + ": left out: " + left_out.reason;
    for (const std::string& note : entry.report.notes) text += "\n- " + note;
    if (!entry.report.notes.empty() || !entry.report.left_out.empty()) text += '\n';
    if (!entry.report.plot_fault.empty()) text += "\nNot all plots: " + entry.report.plot_fault + "\n";
    for (const std::string& file : entry.report.files)
        text +=
            isPlot(file) ? "\n![" + file + "](" + file + ")\n" : "\nTable: [" + file + "](" + file + ")\n";
    return text;
}

}  // namespace

std::vector<std::string> damageLines(const std::vector<StudyInput>& inputs) {
    std::vector<std::string> lines;
    for (const StudyInput& input : inputs)
        if (input.damage != nullptr && !input.damage->text().empty())
            lines.push_back(input.name + ": " + input.damage->text());
    return lines;
}

void writeIndex(const std::string& folder, const std::vector<StudyInput>& inputs, const StudyIndex& index) {
    std::string text = "# Study\n\nMade by roevo-study " + std::string(versionText()) + " on " + index.time +
                       " (UTC)" + ":\n\n    " + index.command + "\n\n" + machineLines() + "\n" +
                       inputTable(inputs, index.left_out);
    text += "\n";
    for (const std::string& line : damageLines(inputs)) text += "- " + line + "\n\n";
    text += protocolText();
    for (const IndexEntry& entry : index.entries) text += entryText(entry);
    writeTextAtomically((std::filesystem::path(folder) / "study.md").string(), text);
}

}  // namespace roevo
