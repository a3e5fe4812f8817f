#pragma once
/// What takes bytes from outside, for a fuzzer: the readers of every kind of file, and the odometry itself.
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace roevo::fuzz {

/// A promise that some input breaks.
struct Broken : std::logic_error {
    using std::logic_error::logic_error;
};

struct Target {
    const char* name;
    /// Any bytes will do. Whatever a reader may not throw goes through. @throws Broken
    void (*run)(std::string_view bytes);
    /// What a user might give, small; made when called.
    std::vector<std::string> (*seeds)();
};

const std::vector<Target>& targets();

void runDatasetFolder(std::string_view bytes);  ///< the text files of a recording, by its layout
std::vector<std::string> datasetFolderSeeds();
void runCameraFile(std::string_view bytes);
std::vector<std::string> cameraFileSeeds();
void runCalibrationFile(std::string_view bytes);  ///< of other programs
std::vector<std::string> calibrationFileSeeds();
void runArray(std::string_view bytes);  ///< numpy's, after its first word
std::vector<std::string> arraySeeds();
void runOtherFolder(
    std::string_view bytes);  ///< the text files of folders as phones and other programs write them
std::vector<std::string> otherFolderSeeds();
void runOptions(std::string_view bytes);  ///< an .ini
std::vector<std::string> optionsSeeds();
void runTrajectory(std::string_view bytes);  ///< TUM
std::vector<std::string> trajectorySeeds();
void runRawlog(std::string_view bytes);
std::vector<std::string> rawlogSeeds();
void runBag(std::string_view bytes);  ///< of the kind that the first byte says
std::vector<std::string> bagSeeds();
void runMap(std::string_view bytes);  ///< what a map file has after its checksum, or the file as it is
std::vector<std::string> mapSeeds();
void runFrames(std::string_view bytes);  ///< camera, then images of any size, type and content
std::vector<std::string> framesSeeds();

}  // namespace roevo::fuzz
