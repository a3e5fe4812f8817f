#pragma once
/// For command-line tests: runs one of our programs and catches what it says.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace roevo::test {

inline std::string readFile(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

inline void writeFile(const std::filesystem::path& path, const std::string& text) {
    std::ofstream out(path, std::ios::binary);
    out << text;
    ASSERT_TRUE(out.good()) << path;
}

/// A folder of the running test's own, empty at first and removed afterwards.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "roevo_test_XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }

  private:
    std::filesystem::path path_;
};

struct ProgramResult {
    int exit_code = -1;  ///< 128 + signal when it was killed
    std::string out, err;

    std::string all() const {
        return "exit code " + std::to_string(exit_code) + "\nstdout:\n" + out + "\nstderr:\n" + err;
    }
};

/// Runs ROEVO_BIN_DIR/<name> (or an absolute path) with arguments and waits for its end.
inline ProgramResult runProgram(const std::string& name, const std::vector<std::string>& arguments) {
    const TemporaryFolder folder;
    const std::string program = name.front() == '/' ? name : std::string(ROEVO_BIN_DIR) + "/" + name;
    const std::string out_file = folder / "out", err_file = folder / "err";
    std::vector<char*> argv{const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);

    const pid_t child = fork();
    if (child == 0) {
        const int out = open(out_file.c_str(), O_CREAT | O_WRONLY, 0600);
        const int err = open(err_file.c_str(), O_CREAT | O_WRONLY, 0600);
        dup2(out, STDOUT_FILENO);
        dup2(err, STDERR_FILENO);
        execv(program.c_str(), argv.data());
        _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ProgramResult result;
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.out = readFile(out_file);
    result.err = readFile(err_file);
    return result;
}

/// The same, but ended with exit code 124 when it takes longer than some seconds: for what might hang.
inline ProgramResult runForSeconds(int seconds, const std::string& name, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {std::to_string(seconds), std::string(ROEVO_BIN_DIR) + "/" + name});
    return runProgram("/usr/bin/timeout", arguments);
}

/// The same with one of the shell's limits in force, e.g. "-f 64" (kB that a file may have).
inline ProgramResult runLimited(const std::string& limit, const std::string& name,
                                std::vector<std::string> arguments) {
    const std::string program = std::string(ROEVO_BIN_DIR) + "/" + name;
    arguments.insert(arguments.begin(),
                     {"-c", "ulimit -c 0; ulimit " + limit + "; exec \"$0\" \"$@\"", program});
    return runProgram("/bin/bash", arguments);
}

/// The program failed as programs of ours should: with this exit code and one line, `name: error: …`, that
/// has all the given words in it.
inline void expectError(const ProgramResult& result, int exit_code, const std::string& name,
                        const std::vector<std::string>& words) {
    EXPECT_EQ(result.exit_code, exit_code) << result.all();
    const std::string prefix = name + ": error: ";
    const std::size_t begin = result.err.find(prefix);
    ASSERT_NE(begin, std::string::npos) << result.all();
    const std::string message = result.err.substr(begin);
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << "one line, the last:\n" << result.err;
    for (const std::string& word : words)
        EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
}

}  // namespace roevo::test
