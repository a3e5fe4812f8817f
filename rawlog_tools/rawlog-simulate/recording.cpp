#include "recording.h"

#include <filesystem>

#include "layout.h"
#include "programs/atomic_file.h"
#include "roevo_mrpt/rawlog_writer.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using simulator::SimulatedFrame;

class RawlogRecording : public Recording {
  public:
    RawlogRecording(const std::string& path, const PinholeCamera& camera)
        : writer_(path, camera),
          truth_((fs::path(path).parent_path() / (fs::path(path).stem().string() + "_groundtruth.txt"))
                     .string()) {
        truth_.stream() << kTruthHeader;
    }
    void add(const SimulatedFrame& frame) override {
        writer_.add(frame.timestamp, simulator::quantiseDepth(frame.depth_noisy), frame.colour);
        truth_.stream() << truthLine(frame.timestamp, frame.T_world_camera);
    }
    void finish() override {
        truth_.close();
        writer_.finish();
        truth_.commit();
    }

  private:
    RawlogWriter writer_;
    AtomicFile truth_;
};

}  // namespace

std::unique_ptr<Recording> openRecording(const std::string& layout, const std::string& path,
                                         const simulator::SimulationOptions& options,
                                         const PinholeCamera& camera) {
    if (layout == "rawlog") return std::make_unique<RawlogRecording>(path, camera);
    return recordFolder(layout, path, options, camera);
}

}  // namespace roevo
