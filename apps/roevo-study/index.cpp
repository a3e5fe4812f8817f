#include "index.h"

#include <filesystem>

#include "support/atomic_file.h"
#include "support/program.h"

namespace roevo {
namespace {

bool isPlot(const std::string& file) {
    return std::filesystem::path(file).extension() == ".svg";
}

// Inside a table a bar would end the cell.
std::string cell(const std::string& text) {
    std::string safe;
    for (const char c : text) safe += c == '|' ? "\\|" : std::string(1, c);
    return safe;
}

}  // namespace

std::string commandLine(int argc, const char* const* argv) {
    constexpr char kPlain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+@%";
    std::string line;
    for (int i = 0; i < argc; ++i) {
        const std::string argument =
            i == 0 ? std::filesystem::path(argv[0]).filename().string() : std::string(argv[i]);
        if (i > 0) line += ' ';
        if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos) {
            line += argument;
            continue;
        }
        line += '\'';
        for (const char c : argument) line += c == '\'' ? "'\\''" : std::string(1, c);
        line += '\'';
    }
    return line;
}

void writeIndex(const std::string& folder, const std::vector<StudyInput>& inputs, const StudyIndex& index) {
    std::string text = "# Study\n\nMade by roevo-study " + std::string(versionText()) + ":\n\n    " +
                       index.command +
                       "\n\n| recording | input | camera | ground truth |\n|---|---|---|---|\n";
    for (const StudyInput& input : inputs)
        text += "| " + cell(input.name) + " | " + cell(input.path) + " | " +
                std::to_string(input.camera.width) + " x " + std::to_string(input.camera.height) + " | " +
                cell(input.ground_truth_note) + " |\n";
    for (const IndexEntry& entry : index.entries) {
        text += "\n## " + entry.title + "\n\n";
        if (!entry.failure.empty()) {
            text += "Failed: " + entry.failure + "\n";
            continue;
        }
        text += entry.report.summary + "\n";
        for (const std::string& note : entry.report.notes) text += "\n- " + note;
        if (!entry.report.notes.empty()) text += '\n';
        if (!entry.report.plot_fault.empty()) text += "\nNot all plots: " + entry.report.plot_fault + "\n";
        for (const std::string& file : entry.report.files)
            text += isPlot(file) ? "\n![" + file + "](" + file + ")\n"
                                 : "\nTable: [" + file + "](" + file + ")\n";
    }
    writeTextAtomically((std::filesystem::path(folder) / "study.md").string(), text);
}

}  // namespace roevo
