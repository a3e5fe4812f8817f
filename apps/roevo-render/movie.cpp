#include "movie.h"

#include <cstdlib>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>

#include "programs/atomic_file.h"
#include "programs/progress.h"

namespace roevo {
namespace {

bool openWriter(cv::VideoWriter& writer, const std::string& file, cv::Size size) {
    for (const char* code : {"avc1", "mp4v"})
        if (writer.open(file, cv::CAP_FFMPEG, cv::VideoWriter::fourcc(code[0], code[1], code[2], code[3]),
                        kMovieRate, size))
            return true;
    return false;
}

// OpenCV does not tell what could not be written.
bool isWhole(const std::string& file, std::size_t count) {
    cv::VideoCapture movie(file, cv::CAP_FFMPEG);
    return movie.isOpened() && movie.get(cv::CAP_PROP_FRAME_COUNT) == static_cast<double>(count);
}

}  // namespace

void writeMovie(const std::string& file, cv::Size size, std::size_t count,
                const std::function<cv::Mat(std::size_t)>& draw) {
    AtomicFile movie(file);
    movie.stream();                             // what cannot be written is said before the work is done
    setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);  // encoders print what they do
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    cv::VideoWriter writer;
    if (!openWriter(writer, movie.temporaryPath(), size))
        throw std::runtime_error("cannot write " + file +
                                 ": this OpenCV has no FFmpeg with an encoder for MP4 (H.264 or MPEG-4)");
    Progress progress("movie", count);
    for (std::size_t i = 0; i < count; ++i) {
        writer.write(draw(i));
        progress.update(i + 1);
    }
    progress.finish();
    writer.release();
    if (!isWhole(movie.temporaryPath(), count))
        throw std::runtime_error("cannot write " + file + ": the movie is not whole; disk full?");
    movie.commit();
}

}  // namespace roevo
