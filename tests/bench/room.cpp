#include "bench/room.h"

#include <opencv2/core/utility.hpp>

#include "edges/edge_extractor.h"
#include "roevo_simulator/simulator.h"

namespace roevo::bench {
namespace {

constexpr int kFrames = 60;

Room makeRoom() {
    simulator::SimulationOptions simulation;
    simulation.useKinectNoise();
    simulation.frames = kFrames;
    const simulator::Simulator simulator(simulation);
    Room room;
    room.camera = simulator.camera();
    for (int i = 0; i < kFrames; ++i) {
        const simulator::SimulatedFrame frame = simulator.frame(i);
        room.frames.push_back({frame.timestamp, frame.grey, frame.depth_noisy, cv::Mat()});
    }
    cv::setNumThreads(1);  // everything is timed on one core

    const OdometryOptions options;
    const RgbdFrame& first = room.frames.front();
    computeGradient(first.grey, options.edges.blur_sigma, room.gradient);
    room.thresholds = cannyThresholds(room.gradient, options.edges);
    canny(room.gradient, room.thresholds, room.raw_mask);
    EdgeMask mask;
    EdgeExtractor(options.edges).extract(first.grey, room.edges, mask);
    room.pyramid.build(first.grey, options.coarse.levels);
    room.points = liftEdges(room.edges, first.depth, room.camera, RowMotion(), options.edges, options.sensor);
    room.photometric = samplePhotometricPoints(room.points, room.pyramid, options.coarse.max_points);
    return room;
}

}  // namespace

const Room& room() {
    static const Room room = makeRoom();
    return room;
}

}  // namespace roevo::bench
