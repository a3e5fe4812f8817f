// The whole odometry, a frame per iteration.
#include <benchmark/benchmark.h>

#include <memory>

#include "bench/room.h"
#include "roevo/odometry.h"

namespace roevo::bench {
namespace {

void processFrame(benchmark::State& state) {
    OdometryOptions options;
    options.mode = state.range(0) != 0 ? Mode::kTracking : Mode::kCoarse;
    state.SetLabel(toString(options.mode));
    const Room& sequence = room();
    std::unique_ptr<Odometry> odometry;
    std::size_t next = sequence.frames.size();
    StageTimes sum;
    double keyframes = 0, frames = 0;
    for (auto _ : state) {
        if (next == sequence.frames.size()) {  // from the beginning again, the first frame not counted
            state.PauseTiming();
            odometry = std::make_unique<Odometry>(sequence.camera, options);
            (void)odometry->processFrame(sequence.frames.front());
            next = 1;
            state.ResumeTiming();
        }
        const FrameResult result = odometry->processFrame(sequence.frames[next++]);
        if (result.status != FrameStatus::kOk) {
            state.SkipWithError("a frame was not tracked");
            break;
        }
        sum.edges += result.ms.edges;
        sum.coarse += result.ms.coarse;
        sum.fine += result.ms.fine;
        keyframes += result.new_keyframe ? 1 : 0;
        ++frames;
    }
    if (frames == 0) return;
    state.counters["edges_ms"] = sum.edges / frames;
    state.counters["coarse_ms"] = sum.coarse / frames;
    state.counters["fine_ms"] = sum.fine / frames;
    state.counters["keyframes"] = keyframes / frames;
}
BENCHMARK(processFrame)->ArgName("fine")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->MinTime(2);

}  // namespace
}  // namespace roevo::bench
