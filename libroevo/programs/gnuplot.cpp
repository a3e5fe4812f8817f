#include "programs/gnuplot.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "programs/atomic_file.h"
#include "programs/interrupt.h"
#include "programs/process.h"
#include "programs/text.h"

namespace roevo {
namespace {

constexpr double kTimeout = 60;  // s; a plot takes a fraction of one

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
)";

/// A file in memory that other programs can open by its path: nothing is left of it, whatever ends this one.
class MemoryFile {
  public:
    MemoryFile() : fd_(memfd_create("gnuplot", MFD_CLOEXEC)) {
        if (fd_ < 0) throw std::runtime_error(std::string("no memory for a plot: ") + std::strerror(errno));
    }
    ~MemoryFile() { close(fd_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    std::string path() const { return "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(fd_); }
    void write(const std::string& text) const {
        std::ofstream out(path(), std::ios::binary);
        out << text;
        out.close();
        if (!out) throw std::runtime_error("no memory for a plot");
    }
    std::string read() const {
        std::ifstream in(path(), std::ios::binary);
        std::ostringstream text;
        text << in.rdbuf();
        return text.str();
    }

  private:
    int fd_;
};

std::string wholeScript(const std::string& script, int width, int height, const std::string& output) {
    std::ostringstream text;
    text << "set terminal svg size " << width << ',' << height
         << " enhanced font 'Helvetica,Arial,sans-serif,14' background rgb 'white'\nset output '" << output
         << "'\n"
         << kLook << script << '\n';
    return text.str();
}

}  // namespace

std::string drawSvgText(const std::string& script, int width, int height) {
    const std::string program = findProgram("gnuplot");
    if (program.empty()) throw NoGnuplot("gnuplot is not installed (package gnuplot-nox)");
    const MemoryFile commands, picture;
    commands.write(wholeScript(script, width, height, picture.path()));
    // -d: not with the settings of whoever runs this, which could change every plot
    ChildProcess gnuplot({program, "-d", commands.path()}, -1, kTimeout);
    const ProcessEnd& end = gnuplot.finish();
    const std::string complaint = replaceAll(gnuplot.lastError(), '"' + commands.path() + "\" ", "");
    if (end.timed_out) throw std::runtime_error("gnuplot did not come to an end");
    if (!end.ok())
        throw std::runtime_error("gnuplot failed: " + (complaint.empty() ? "no reason given" : complaint));
    // It ends well even where it drew no plot
    std::string svg = picture.read();
    if (svg.find("</svg>") == std::string::npos)
        throw std::runtime_error("gnuplot drew nothing" + (complaint.empty() ? "" : ": " + complaint));
    return svg;
}

void drawSvg(const std::string& path, const std::string& script, int width, int height) {
    std::string svg;
    try {
        svg = drawSvgText(script, width, height);
    } catch (const Interrupted&) {
        throw;
    } catch (const NoGnuplot& e) {
        throw NoGnuplot("cannot draw " + path + ": " + e.what());
    } catch (const std::runtime_error& e) {
        throw std::runtime_error("cannot draw " + path + ": " + e.what());
    }
    writeTextAtomically(path, svg);
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
