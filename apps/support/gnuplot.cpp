#include "support/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "support/atomic_file.h"

extern char** environ;

namespace roevo {
namespace {

namespace fs = std::filesystem;

// Okabe and Ito's palette: eight colours that stay apart with any kind of colour vision.
constexpr char kLook[] = R"(
set encoding utf8
set linetype 1 lc rgb '#0072B2' lw 2 pt 7
set linetype 2 lc rgb '#D55E00' lw 2 pt 5
set linetype 3 lc rgb '#009E73' lw 2 pt 9
set linetype 4 lc rgb '#CC79A7' lw 2 pt 13
set linetype 5 lc rgb '#E69F00' lw 2 pt 11
set linetype 6 lc rgb '#56B4E9' lw 2 pt 6
set linetype 7 lc rgb '#555555' lw 2 pt 4
set linetype 8 lc rgb '#A6761D' lw 2 pt 8
set linetype cycle 8
set border 3 lc rgb '#666666' lw 1
set tics nomirror textcolor rgb '#333333'
set grid lc rgb '#dddddd' lw 1 dt 1
set key textcolor rgb '#333333' samplen 2 spacing 1.15
set title textcolor rgb '#222222'
set xlabel textcolor rgb '#333333'
set ylabel textcolor rgb '#333333'
set style fill solid 0.9 noborder
set datafile missing 'NaN'
)";

/// A file of our own in the temporary folder, gone at the end.
class ScratchFile {
  public:
    ScratchFile() {
        std::string pattern = (fs::temp_directory_path() / "roevo_gnuplot_XXXXXX").string();
        const int file = mkstemp(pattern.data());
        if (file < 0) throw std::runtime_error("cannot create " + pattern + ": " + std::strerror(errno));
        close(file);
        path_ = pattern;
    }
    ~ScratchFile() { unlink(path_.c_str()); }
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;

    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

std::string firstComplaint(const std::string& path) {
    std::ifstream in(path);
    std::string all;
    for (std::string line; std::getline(in, line);) {
        const std::size_t begin = line.find_first_not_of(" \t^");
        if (begin == std::string::npos) continue;
        all += (all.empty() ? "" : " / ") + line.substr(begin);
    }
    return all;
}

// Runs `gnuplot script` with its outputs into files. @return 0, or an errno when it could not be started;
// `status` as from waitpid()
int spawnGnuplot(const std::string& script, const std::string& out, const std::string& err, int& status) {
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
    std::string program = "gnuplot", argument = script;
    char* argv[] = {program.data(), argument.data(), nullptr};
    pid_t child = 0;
    const int fault = posix_spawnp(&child, program.c_str(), &files, nullptr, argv, environ);
    posix_spawn_file_actions_destroy(&files);
    if (fault != 0) return fault;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return errno;
    return 0;
}

}  // namespace

void drawSvg(const std::string& path, const std::string& script, int width, int height) {
    const ScratchFile commands, complaints;
    {
        std::ofstream out(commands.path());
        out << "set terminal svg size " << width << ',' << height
            << " enhanced font 'Helvetica,Arial,sans-serif,14' background rgb 'white'\n"
            << kLook << script << '\n';
        out.close();
        if (!out) throw std::runtime_error("cannot write " + commands.path() + ": is the disk full?");
    }
    AtomicFile file(path);
    file.stream();  // tells why when the folder cannot be written to
    int status = 0;
    if (const int fault = spawnGnuplot(commands.path(), file.temporaryPath(), complaints.path(), status)) {
        if (fault == ENOENT)
            throw std::runtime_error("cannot draw " + path +
                                     ": gnuplot is not installed (package gnuplot-nox)");
        throw std::runtime_error("cannot draw " + path + ": gnuplot cannot be run: " + std::strerror(fault));
    }
    const std::string complaint = firstComplaint(complaints.path());
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw std::runtime_error("cannot draw " + path +
                                 ": gnuplot failed: " + (complaint.empty() ? "no reason given" : complaint));
    // It ends well even where it drew no plot
    std::ifstream drawn(file.temporaryPath());
    std::ostringstream svg;
    svg << drawn.rdbuf();
    if (svg.str().find("</svg>") == std::string::npos)
        throw std::runtime_error("cannot draw " + path + ": gnuplot drew nothing" +
                                 (complaint.empty() ? "" : ": " + complaint));
    file.commit();
}

std::string gnuplotText(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) {
        if (c == '\n' || c == '\r') {
            quoted += ' ';
            continue;
        }
        if (std::strchr("_^{}@&~\\", c) != nullptr && c != '\0') quoted += '\\';
        quoted += c;
        if (c == '\'') quoted += c;
    }
    return quoted + "'";
}

std::string gnuplotData(const std::string& name, const std::vector<std::vector<double>>& rows) {
    std::string text = "$" + name + " << END_OF_DATA\n";
    for (const std::vector<double>& row : rows) {
        for (const double value : row) {
            char number[40];
            std::snprintf(number, sizeof number, "%.9g ", value);
            text += std::isfinite(value) ? number : "NaN ";
        }
        text += '\n';
    }
    return text + "END_OF_DATA\n";
}

}  // namespace roevo
