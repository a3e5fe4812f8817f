// Errors quote what they read so that it can be read: 80 printable characters of it.
#include <gtest/gtest.h>

#include "input/excerpt.h"
#include "support/run_program.h"
#include "support/tum_folder.h"

namespace roevo {
namespace {

using test::expectError;

TEST(Excerpt, KeepsWhatCanBePrinted) {
    EXPECT_EQ(excerpt("0.5"), "0.5");
    EXPECT_EQ(excerpt("Büro – 書斎"), "Büro – 書斎");
    EXPECT_EQ(excerpt(std::string("a\0b\x1b[31m\xff\xc3\n", 11)), "a?b?[31m???");
    EXPECT_EQ(excerpt("\xc2\x9b"), "?") << "a control character in two bytes";
}

TEST(Excerpt, IsOfEightyCharactersAtMost) {
    EXPECT_EQ(excerpt(std::string(80, 'x')), std::string(80, 'x'));
    EXPECT_EQ(excerpt(std::string(81, 'x')), std::string(79, 'x') + "…");
    std::string umlauts;
    for (int i = 0; i < 100; i++) umlauts += "ü";
    EXPECT_EQ(excerpt(umlauts), umlauts.substr(0, 158) + "…");
}

class ShownText : public testing::Test {
  protected:
    /// An error of one line that names the file, and neither binary nor long.
    static void expectReadable(const test::ProgramResult& result, const std::string& name,
                               const std::vector<std::string>& words) {
        expectError(result, 1, name, words);
        for (const std::string& text : {result.out, result.err}) {
            EXPECT_LT(text.size(), 2000u) << text.substr(0, 2000);
            for (std::size_t i = 0; i < text.size(); i += std::max<std::size_t>(utf8Length(text, i), 1))
                EXPECT_TRUE(text[i] == '\n' || text[i] == '\r' ||
                            (utf8Length(text, i) > 0 && !isControl(text, i)))
                    << "byte " << i;
        }
    }

    const test::TemporaryFolder folder_;
    const std::vector<std::string> nasty_ = {std::string(150000, 'x'), "\x1b[2J\x01\xff\xfe\x07",
                                             std::string(150000, '\xff')};
};

TEST_F(ShownText, OfTrajectories) {
    test::writeFile(folder_ / "good.txt", "1 0 0 0 0 0 0 1\n");
    for (const std::string& word : nasty_) {
        test::writeFile(folder_ / "bad.txt", "1 0 0 0 0 0 0 1\n2 0 " + word + " 0 0 0 0 1\n");
        expectReadable(test::runProgram("roevo-eval", {"--reference", folder_ / "good.txt", "--estimate",
                                                       folder_ / "bad.txt"}),
                       "roevo-eval", {"bad.txt:2: '", "is not a number"});
    }
}

TEST_F(ShownText, OfConfigFiles) {
    test::writeTumFolder(folder_ / "recording", test::slidingRecording(2));
    for (const std::string& word : nasty_)
        for (const std::string& line : {word, word + " = 1", "mode = " + word, "[" + word + "]\nmode = tr"}) {
            test::writeFile(folder_ / "bad.ini", "[odometry]\n" + line + "\n");
            expectReadable(
                test::runProgram("roevo-odometry", {"--input", folder_ / "recording", "--output",
                                                    folder_ / "out", "--config", folder_ / "bad.ini"}),
                "roevo-odometry", {"bad.ini:"});
        }
}

TEST_F(ShownText, OfDatasets) {
    const std::string recording = folder_ / "recording";
    const auto run = [&] {
        return test::runProgram("rgbd2rawlog", {"--input", recording, "--output", folder_ / "o.rawlog"});
    };
    for (const std::string& word : nasty_) {
        test::writeTumFolder(recording, test::slidingRecording(2));
        test::writeFile(recording + "/camera.txt", "width: " + word + "\n");
        expectReadable(run(), "rgbd2rawlog", {"camera.txt:1: '", "is not a number"});
        test::writeFile(recording + "/rgb.txt", "0.1 rgb/" + word + "\n");
        expectReadable(run(), "rgbd2rawlog", {"rgb.txt:1: '", "cannot be a file name"});
        test::writeFile(recording + "/rgb.txt", word + " rgb/0000.png\n");
        expectReadable(run(), "rgbd2rawlog", {"rgb.txt:1: '", "is not a number"});
    }
}

}  // namespace
}  // namespace roevo
