// Files that programs write: rawlogs and bags.
#include <sys/resource.h>
#include <unistd.h>

#include <exception>
#include <filesystem>
#include <fstream>
#include <new>

#include "fuzz/promises.h"
#include "mrpt/synthetic_scan.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/rawlog_reader.h"
#include "tools/ros_recording.h"

namespace roevo::fuzz {
namespace {

using test::TemporaryFolder;

constexpr int kFrames = 10;  ///< of a recording, at most: it can claim any number

void requireFrame(const RgbdFrame& frame, const PinholeCamera& camera) {
    require(frame.grey.type() == CV_8UC1 && frame.depth.type() == CV_32FC1 &&
                frame.grey.size() == cv::Size(camera.width, camera.height) &&
                frame.depth.size() == frame.grey.size(),
            "a frame does not fit its camera");
}

rlimit limit_before;

/// A scan of MRPT's makes room even where it is destroyed, and the program ends where there is none: programs
/// say so in one line, fuzzing goes on.
void lastRoom() {
    if (std::uncaught_exceptions() == 0) throw std::bad_alloc();
    setrlimit(RLIMIT_AS, &limit_before);
    std::set_new_handler(nullptr);
}

/// MRPT makes room for as much as a file claims to have before it reads it: not for any amount while this
/// lives.
class MemoryLimit {
  public:
    MemoryLimit() {
        getrlimit(RLIMIT_AS, &limit_before);
        std::set_new_handler(lastRoom);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__clang__)  // these take a lot
        std::size_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        rlimit limit = limit_before;
        limit.rlim_cur =
            std::min<rlim_t>(limit_before.rlim_max,
                             pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + (rlim_t{256} << 20));
        setrlimit(RLIMIT_AS, &limit);
#endif
    }
    ~MemoryLimit() {
        std::set_new_handler(nullptr);
        setrlimit(RLIMIT_AS, &limit_before);
    }
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;
};

}  // namespace

void runRawlog(std::string_view bytes) {
    static const TemporaryFolder folder;
    const MemoryLimit limit;
    test::writeFile(folder / "a.rawlog", std::string(bytes));
    accepted([&] {
        RawlogReader reader(folder / "a.rawlog");
        for (int i = 0; i < kFrames; i++) {
            const auto scan = reader.next();
            if (!scan) break;
            accepted([&] {
                const RgbdFrame frame = toRgbdFrame(*scan);
                requireFrame(frame, colourCameraOf(*scan));
                requireRigid(cameraOnRobot(*scan));
            });
        }
        (void)reader.report().warning();
    });
}

std::vector<std::string> rawlogSeeds() {
    PinholeCamera camera = test::smallCamera();
    camera.width = 16, camera.height = 12, camera.cx = 7.2, camera.cy = 5.6;
    const auto recording = [&] {
        std::string bytes;
        for (int i = 0; i < 2; i++)
            bytes += test::bytesOf(*test::makeScan(100 + i / 30., camera, test::patternDepth(camera, i),
                                                   test::patternColour(camera, i)));
        return bytes;
    };
    const std::string as_pixels = recording();
    const test::ColourAsJpeg jpeg;
    return {as_pixels, recording()};
}

/// The first byte says what the file's name ends in.
void runBag(std::string_view bytes) {
    static const TemporaryFolder folder;
    if (bytes.empty()) return;
    const char* const endings[] = {".bag", ".db3", ".mcap"};
    const std::string file = folder / (std::string("a") + endings[static_cast<unsigned char>(bytes[0]) % 3]);
    test::writeBytes(file, std::string(bytes.substr(1)));
    accepted([&] {
        const DatasetReader bag = openDataset(file);
        for (std::size_t i = 0; i < std::min<std::size_t>(bag.size(), kFrames); i++)
            accepted([&] { requireFrame(bag.readFrame(i), bag.camera()); });
    });
}

std::vector<std::string> bagSeeds() {
    const TemporaryFolder folder;
    std::vector<std::string> seeds;
    for (const test::BagKind& kind : test::kBagKinds) {
        const std::string ending = kind.ending;
        if (ending.empty()) continue;  // folders are made of the others
        const std::string file = kind.write(folder / ("a" + ending), test::tinyRecording(kind.encoding, 1));
        seeds.push_back((ending == ".bag" ? '\0' : ending == ".db3" ? '\1' : '\2') + test::readFile(file));
    }
    return seeds;
}

}  // namespace roevo::fuzz
