// Who includes whom: the arrows between the parts of the tree run one way (docs/architecture.md, Layers).
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "support/run_program.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

struct Part {
    std::string name;
    std::vector<std::string> folders;
    std::set<std::string> may_include;  ///< beside itself
};

const std::vector<Part> kParts = {
    {"core", {"libroevo/include", "libroevo/src"}, {}},
    {"mrpt_module", {"libroevo/mrpt_module"}, {"core", "MRPT"}},
    {"programs", {"libroevo/programs"}, {"core", "mrpt_module"}},
    {"evaluation", {"libroevo/evaluation"}, {"core", "programs"}},
    {"recordings", {"libroevo/recordings"}, {"core", "mrpt_module", "MRPT", "programs", "evaluation"}},
    {"apps", {"apps"}, {"core", "mrpt_module", "MRPT", "programs", "evaluation", "recordings"}},
    {"rawlog_tools",
     {"rawlog_tools"},
     {"core", "mrpt_module", "MRPT", "programs", "evaluation", "recordings"}},
};

/// Where a target of ours has the compiler look, beside the including file's own folder.
const std::vector<std::string> kRoots = {"libroevo/include",
                                         "libroevo/mrpt_module/include",
                                         "libroevo",
                                         "libroevo/src",
                                         "libroevo/mrpt_module/src",
                                         "apps",
                                         "rawlog_tools",
                                         "apps/roevo-compare",
                                         "apps/roevo-study",
                                         "rawlog_tools/simulator/include",
                                         "rawlog_tools/simulator/src"};

struct Includes {
    std::map<std::string, std::size_t> seen;  ///< number of includes of our own files, by part
    std::vector<std::string> wrong;           ///< "file: what it includes, and why not"
};

bool isBelow(const fs::path& file, const std::string& folder) {
    const fs::path relative = file.lexically_relative(folder);
    return !relative.empty() && *relative.begin() != "..";
}

/// Name of the part that a path from the tree's root belongs to, or "".
std::string partOf(const fs::path& file) {
    for (const Part& part : kParts)
        for (const std::string& folder : part.folders)
            if (isBelow(file, folder)) return part.name;
    return "";
}

/// What an #include means: a path from the tree's root, or "" for what is not ours.
fs::path resolve(const fs::path& tree, const fs::path& including, const std::string& included) {
    std::vector<fs::path> folders = {including.parent_path()};
    folders.insert(folders.end(), kRoots.begin(), kRoots.end());
    for (const fs::path& folder : folders) {
        const fs::path file = (folder / included).lexically_normal();
        if (fs::is_regular_file(tree / file)) return file;
    }
    return {};
}

void checkFile(const fs::path& tree, const fs::path& file, const Part& part, Includes& out) {
    static const std::regex kInclude(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
    std::ifstream in(tree / file);
    std::smatch match;
    for (std::string line; std::getline(in, line);) {
        if (!std::regex_search(line, match, kInclude)) continue;
        const std::string included = match[2];
        const fs::path resolved = resolve(tree, file, included);
        const bool is_mrpt = included.rfind("mrpt/", 0) == 0 || included == "mrpt";
        const std::string to = is_mrpt ? "MRPT" : partOf(resolved);
        if (to.empty() && match[1] == "<") continue;  // of the system
        ++out.seen[part.name];
        if (to == part.name || part.may_include.count(to) > 0) continue;
        out.wrong.push_back(file.string() + ": " + included +
                            (to.empty() ? " is no file of ours" : ", " + part.name + " must not know " + to));
    }
}

Includes checkTree(const fs::path& tree) {
    static const std::set<std::string> kEndings = {".h", ".hpp", ".cpp"};
    Includes out;
    for (const Part& part : kParts)
        for (const std::string& folder : part.folders) {
            if (!fs::is_directory(tree / folder)) continue;
            for (const auto& entry : fs::recursive_directory_iterator(tree / folder))
                if (entry.is_regular_file() && kEndings.count(entry.path().extension().string()) > 0)
                    checkFile(tree, entry.path().lexically_relative(tree), part, out);
        }
    std::sort(out.wrong.begin(), out.wrong.end());
    return out;
}

TEST(Includes, RunOneWay) {
    const Includes includes = checkTree(ROEVO_SOURCE_DIR);
    for (const std::string& wrong : includes.wrong) ADD_FAILURE() << wrong;
    for (const Part& part : kParts) EXPECT_GT(includes.seen.count(part.name), 0u) << part.name;
}

/// A tree with a header in each part, to which a test adds a file.
class WrongWays : public ::testing::Test {
  protected:
    void SetUp() override {
        for (const char* header :
             {"libroevo/include/roevo/types.h", "libroevo/src/odometry/stopwatch.h",
              "libroevo/mrpt_module/include/roevo_mrpt/rawlog_reader.h", "libroevo/programs/progress.h",
              "libroevo/evaluation/ate.h", "libroevo/recordings/frame_source.h",
              "apps/roevo-compare/method.h", "rawlog_tools/rgbd2rawlog/convert.h"})
            add(header, "#pragma once\n");
    }

    void add(const std::string& file, const std::string& text) const {
        fs::create_directories(fs::path(tree_ / file).parent_path());
        test::writeFile(tree_ / file, text);
    }

    std::vector<std::string> wrongIn(const std::string& file, const std::string& included) const {
        add(file, "#include " + included + "\n");
        const std::vector<std::string> wrong = checkTree(tree_.path()).wrong;
        fs::remove(tree_ / file);
        return wrong;
    }

    test::TemporaryFolder tree_;
};

TEST_F(WrongWays, AreSeen) {
    const struct {
        const char *file, *included, *why;
    } cases[] = {
        {"apps/roevo-eval/main.cpp", "\"rgbd2rawlog/convert.h\"", "apps must not know rawlog_tools"},
        {"apps/roevo-eval/main.cpp", "\"../../rawlog_tools/rgbd2rawlog/convert.h\"",
         "apps must not know rawlog_tools"},
        {"rawlog_tools/a/b.cpp", "\"roevo-compare/method.h\"", "rawlog_tools must not know apps"},
        {"rawlog_tools/a/b.cpp", "\"method.h\"", "rawlog_tools must not know apps"},
        {"libroevo/recordings/a.cpp", "\"rgbd2rawlog/convert.h\"", "recordings must not know rawlog_tools"},
        {"libroevo/recordings/a.cpp", "\"roevo-compare/method.h\"", "recordings must not know apps"},
        {"libroevo/evaluation/a.h", "\"roevo-compare/method.h\"", "evaluation must not know apps"},
        {"libroevo/evaluation/a.h", "\"recordings/frame_source.h\"", "evaluation must not know recordings"},
        {"libroevo/evaluation/a.h", "\"roevo_mrpt/rawlog_reader.h\"", "evaluation must not know mrpt_module"},
        {"libroevo/programs/a.cpp", "\"evaluation/ate.h\"", "programs must not know evaluation"},
        {"libroevo/programs/a.cpp", "\"rgbd2rawlog/convert.h\"", "programs must not know rawlog_tools"},
        {"libroevo/mrpt_module/src/a.cpp", "\"programs/progress.h\"", "mrpt_module must not know programs"},
        {"libroevo/src/a.cpp", "\"programs/progress.h\"", "core must not know programs"},
        {"libroevo/src/a.cpp", "<evaluation/ate.h>", "core must not know evaluation"},
        {"libroevo/include/roevo/a.h", "\"roevo_mrpt/rawlog_reader.h\"", "core must not know mrpt_module"},
        {"libroevo/include/roevo/a.h", "<mrpt/poses/CPose3D.h>", "core must not know MRPT"},
        {"libroevo/evaluation/a.cpp", "<mrpt/poses/CPose3D.h>", "evaluation must not know MRPT"},
        {"apps/roevo-eval/main.cpp", "\"programs/none.h\"", "is no file of ours"},
    };
    for (const auto& each : cases) {
        const auto wrong = wrongIn(each.file, each.included);
        ASSERT_EQ(wrong.size(), 1u) << each.file << " " << each.included;
        EXPECT_EQ(wrong[0].rfind(std::string(each.file) + ": ", 0), 0u) << wrong[0];
        EXPECT_NE(wrong[0].find(each.why), std::string::npos) << wrong[0];
    }
}

TEST_F(WrongWays, AreNotSeenInTheRightOnes) {
    const std::pair<const char*, const char*> cases[] = {
        {"apps/roevo-eval/main.cpp", "\"evaluation/ate.h\""},
        {"apps/roevo-study/study.cpp", "\"roevo-compare/method.h\""},
        {"apps/roevo-compare/a.cpp", "\"method.h\""},
        {"rawlog_tools/a/b.cpp", "\"recordings/frame_source.h\""},
        {"rawlog_tools/a/b.cpp", "<mrpt/obs/CObservation3DRangeScan.h>"},
        {"libroevo/recordings/a.cpp", "\"roevo_mrpt/rawlog_reader.h\""},
        {"libroevo/evaluation/a.cpp", "\"programs/progress.h\""},
        {"libroevo/programs/a.cpp", "\"roevo_mrpt/rawlog_reader.h\""},
        {"libroevo/src/odometry/a.cpp", "\"stopwatch.h\""},
        {"libroevo/src/a.cpp", "<opencv2/core.hpp>"},
    };
    for (const auto& [file, included] : cases)
        EXPECT_TRUE(wrongIn(file, included).empty()) << file << " " << included;
}

}  // namespace
}  // namespace roevo
