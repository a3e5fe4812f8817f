// datasets_readme/: the list of the paper's sequences is whole, and the pages say the same as the list.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "recordings/dataset_reader.h"
#include "roevo_mrpt/config_file.h"
#include "support/run_program.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kRoot = ROEVO_SOURCE_DIR, kFolder = kRoot / "datasets_readme";
const std::vector<std::string> kMetrics{"ate_cm", "rpe_cm_per_s", "rpe_deg_per_s"};

const json& list() {
    static const json parsed = json::parse(test::readFile(kFolder / "sequences.json"));
    return parsed;
}

std::vector<std::string> linesOf(const fs::path& file) {
    std::istringstream in(test::readFile(file));
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

std::vector<std::string> pages() {
    std::vector<std::string> names{"README.md"};
    for (const auto& dataset : list()["datasets"]) names.push_back(dataset["page"]);
    return names;
}

/// Cells of "| a | b |".
std::vector<std::string> cellsOf(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, '|');) {
        const auto first = cell.find_first_not_of(' ');
        cells.push_back(
            first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(' ') - first + 1));
    }
    if (!cells.empty()) cells.erase(cells.begin());
    return cells;
}

const json* sequenceNamed(const std::string& name) {
    for (const json& sequence : list()["sequences"])
        if (sequence["name"] == name) return &sequence;
    return nullptr;
}

TEST(DatasetsReadme, ListHasThe24SequencesOfThePaper) {
    std::map<std::string, int> count;
    std::set<std::string> names;
    for (const json& sequence : list()["sequences"]) {
        count[sequence["dataset"]]++;
        EXPECT_TRUE(names.insert(sequence["name"]).second) << sequence["name"] << " twice";
    }
    EXPECT_EQ(count, (std::map<std::string, int>{
                         {"ICL-NUIM", 4}, {"TUM RGB-D", 8}, {"ETH3D SLAM", 8}, {"Chair", 4}}));
}

TEST(DatasetsReadme, EverySequenceSaysWhatAProgramNeeds) {
    const auto formats = datasetFormats();
    for (const json& s : list()["sequences"]) {
        const std::string name = s["name"];
        ASSERT_TRUE(list()["datasets"].contains(std::string(s["dataset"]))) << name;
        EXPECT_TRUE(fs::is_regular_file(kFolder /
                                        std::string(list()["datasets"][std::string(s["dataset"])]["page"])));
        OdometryOptions options;
        EXPECT_NO_THROW(
            loadConfigFile((kRoot / "config_ini" / (std::string(s["profile"]) + ".ini")).string(), options));
        EXPECT_TRUE(s.contains("truncation")) << name;
        EXPECT_EQ(!s["truncation"].is_null(), s["dataset"] == "ICL-NUIM") << name;
        EXPECT_TRUE(s["archive_size_gb"].is_null() || s["archive_size_gb"].get<double>() > 0) << name;
        EXPECT_FALSE(std::string(s["camera"]).empty()) << name;
        EXPECT_EQ(s["public"].get<bool>(), !s["urls"].empty()) << name;
        if (!s["public"].get<bool>()) continue;
        for (const std::string url : s["urls"]) EXPECT_EQ(url.rfind("https://", 0), 0u) << url;
        EXPECT_FALSE(std::string(s["folder"]).empty()) << name;
        EXPECT_FALSE(std::string(s["ground_truth"]).empty()) << name;
        EXPECT_NE(std::find(formats.begin(), formats.end(), s["layout"]), formats.end())
            << name << s["layout"];
    }
}

TEST(DatasetsReadme, EverySequenceHasThePapersFigures) {
    std::size_t failed = 0;
    for (const json& s : list()["sequences"]) {
        std::set<std::string> methods;
        for (const auto& item : s["paper"]["ate_cm"].items()) methods.insert(item.key());
        for (const std::string& metric : kMetrics) {
            std::set<std::string> here;
            for (const auto& [method, value] : s["paper"][metric].items()) {
                here.insert(method);
                if (value.is_null())
                    failed++;
                else
                    EXPECT_GT(value.get<double>(), 0) << s["name"] << metric << method;
            }
            EXPECT_EQ(here, methods) << s["name"] << ' ' << metric;
            for (const char* ours : {"ROEVO-CT", "ROEVO-TR", "ROEVO-TR+BA"})
                EXPECT_TRUE(s["paper"][metric][ours].is_number()) << s["name"] << ' ' << metric << ours;
        }
    }
    // Crosses in the ETH3D tables, three metrics: ORB-SLAM3-TR on sofa_3 and plant_scene_1, ManhattanSLAM and
    // RE-SLAM on sofa_3, PHOTO-SLAM on repetitive
    EXPECT_EQ(failed, 15u);
}

// Typed from the paper once more, by hand.
TEST(DatasetsReadme, FiguresAreThePapers) {
    struct Figure {
        const char *name, *metric, *method;
        double value;
    };
    for (const Figure& f : {Figure{"fr1_desk", "ate_cm", "ROEVO-TR+BA", 5.436},
                            Figure{"fr1_desk", "rpe_cm_per_s", "ROEVO-TR", 2.147},
                            Figure{"fr3_nst_tex_f", "rpe_deg_per_s", "ROEVO-TR+BA", 0.747},
                            Figure{"fr3_str_tex_n", "ate_cm", "PHOTO-SLAM", 1.391},
                            Figure{"lr_kt0", "ate_cm", "ROEVO-TR+BA", 0.347},
                            Figure{"lr_kt2", "rpe_cm_per_s", "ROEVO-CT", 1.096},
                            Figure{"lr_kt3", "rpe_deg_per_s", "ManhattanSLAM", 0.086},
                            Figure{"cables_1", "ate_cm", "RE-SLAM", 0.641},
                            Figure{"plant_scene_3", "rpe_cm_per_s", "ORB-SLAM3-TR", 33.28},
                            Figure{"sofa_3", "rpe_deg_per_s", "ROEVO-TR", 1.504},
                            Figure{"1_chair_loop", "ate_cm", "ROEVO-TR+BA", 1.029},
                            Figure{"3_chairs_no_loop", "rpe_cm_per_s", "ROEVO-TR+BA", 0.641},
                            Figure{"3_chairs_loop", "rpe_deg_per_s", "DROID-SLAM", 3.711}}) {
        const json* sequence = sequenceNamed(f.name);
        ASSERT_NE(sequence, nullptr) << f.name;
        EXPECT_EQ((*sequence)["paper"][f.metric][f.method], f.value)
            << f.name << ' ' << f.metric << ' ' << f.method;
    }
}

TEST(DatasetsReadme, TablesOfThePagesAgreeWithTheList) {
    std::size_t compared = 0, expected = 0;
    for (const json& s : list()["sequences"])
        for (const std::string& metric : kMetrics) expected += s["paper"][metric].size();
    for (const auto& dataset : list()["datasets"]) {
        std::string metric;
        std::vector<std::string> columns;
        for (const std::string& line : linesOf(kFolder / std::string(dataset["page"]))) {
            const auto cells = cellsOf(line);
            if (cells.empty() || line[0] != '|') {
                metric.clear();
                continue;
            }
            if (std::count(kMetrics.begin(), kMetrics.end(), cells[0]) == 1) {
                metric = cells[0];
                columns = cells;
            } else if (!metric.empty() && cells[0].rfind("---", 0) != 0) {
                ASSERT_EQ(cells.size(), columns.size()) << line;
                double sum = 0;
                for (std::size_t i = 1; i + 1 < cells.size(); i++, compared++) {
                    const json* sequence = sequenceNamed(columns[i]);
                    ASSERT_NE(sequence, nullptr) << columns[i];
                    const json& value = (*sequence)["paper"][metric].at(cells[0]);
                    if (cells[i] == "failed") {
                        EXPECT_TRUE(value.is_null()) << columns[i] << line;
                    } else {
                        EXPECT_EQ(value, std::stod(cells[i])) << columns[i] << line;
                        sum += std::stod(cells[i]);
                    }
                }
                if (cells[0] == "ROEVO-TR+BA") {  // the paper's own check sum
                    EXPECT_NEAR(sum / static_cast<double>(cells.size() - 2), std::stod(cells.back()), 0.0011)
                        << line;
                }
            }
        }
    }
    EXPECT_EQ(compared, expected);
}

std::string sizeText(double gigabytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f GB", gigabytes);
    return text;
}

TEST(DatasetsReadme, SequencesOfThePagesAgreeWithTheList) {
    std::size_t rows = 0;
    for (const auto& dataset : list()["datasets"])
        for (const std::string& line : linesOf(kFolder / std::string(dataset["page"]))) {
            if (line.find("../config_ini/") == std::string::npos || line[0] != '|') continue;
            const json* s = sequenceNamed(cellsOf(line).front());
            ASSERT_NE(s, nullptr) << line;
            rows++;
            for (const std::string url : (*s)["urls"])
                EXPECT_NE(line.find("<" + url + ">"), std::string::npos) << line;
            if ((*s)["folder"].is_string()) {
                EXPECT_NE(line.find("`" + std::string((*s)["folder"]) + "`"), std::string::npos) << line;
            }
            EXPECT_NE(line.find("[" + std::string((*s)["profile"]) + "]"), std::string::npos) << line;
            const json& size = (*s)["archive_size_gb"];
            EXPECT_EQ(cellsOf(line).at(2), size.is_null() ? "unknown" : sizeText(size.get<double>())) << line;
        }
    EXPECT_EQ(rows, 24u);
}

TEST(DatasetsReadme, LinksLeadSomewhere) {
    for (const std::string& page : pages()) {
        const std::string text = test::readFile(kFolder / page);
        for (std::size_t at = text.find("]("); at != std::string::npos; at = text.find("](", at + 1)) {
            const std::string target = text.substr(at + 2, text.find(')', at) - at - 2);
            EXPECT_TRUE(target.rfind("http", 0) == 0 || fs::exists(kFolder / target))
                << page << ": " << target;
        }
    }
}

/// Words of a command line; quotes are left on.
std::vector<std::string> wordsOf(const std::string& line) {
    std::istringstream in(line);
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

// A command that was renamed, or an option that is gone, must not stay in the pages.
TEST(DatasetsReadme, CommandsNameProgramsAndOptionsThatExist) {
    const std::set<std::string> ours{"rgbd2rawlog", "bag2rawlog",    "roevo-odometry",
                                     "roevo-eval",  "roevo-compare", "roevo-batch"};
    std::map<std::string, std::string> help;
    std::map<std::string, int> used;
    for (const std::string& page : pages())
        for (const std::string& line : linesOf(kFolder / page)) {
            if (line.rfind("    ", 0) != 0) continue;
            const auto words = wordsOf(line);
            if (words.empty() || ours.count(words[0]) == 0) continue;
            const std::string& program = words[0];
            if (program == "bag2rawlog" && !fs::exists(fs::path(ROEVO_BIN_DIR) / program)) continue;
            used[program]++;
            if (help.count(program) == 0) {
                const auto result = test::runProgram(program, {"--help"});
                ASSERT_EQ(result.exit_code, 0) << program;
                help[program] = result.out;
            }
            for (std::size_t i = 1; i < words.size(); i++) {
                if (words[i].rfind("--", 0) == 0) {
                    EXPECT_NE(help[program].find("\n  " + words[i] + " "), std::string::npos)
                        << page << ": " << program << " has no " << words[i];
                }
                if (words[i] == "--config") {
                    const std::string& file = words.at(i + 1);
                    EXPECT_TRUE(fs::exists(kRoot / file.substr(file.find("config_ini/"))))
                        << page << ": " << file;
                }
            }
        }
    EXPECT_GE(used["rgbd2rawlog"], 6);
    EXPECT_GE(used["roevo-odometry"], 10);
    EXPECT_GE(used["roevo-eval"], 7);
    EXPECT_GE(used["roevo-batch"], 1);
    EXPECT_GE(used["roevo-compare"], 1);
}

// The loop over all sequences of a page must have each of them with its folder.
TEST(DatasetsReadme, LoopsRunOverEverySequence) {
    for (const json& s : list()["sequences"]) {
        if (!s["public"].get<bool>()) continue;
        const std::string page =
            test::readFile(kFolder / std::string(list()["datasets"][std::string(s["dataset"])]["page"]));
        const std::string pair = std::string(s["name"]) + ":" + std::string(s["folder"]);
        EXPECT_TRUE(page.find(pair + " \\\n") != std::string::npos ||
                    page.find(pair + "; do") != std::string::npos)
            << pair;
    }
}

}  // namespace
}  // namespace roevo
