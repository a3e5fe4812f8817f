// From grey image to organized edges, stage by stage, and the searches over them.
#include <benchmark/benchmark.h>

#include <opencv2/imgproc.hpp>

#include "bench/room.h"
#include "edges/edge_extractor.h"
#include "edges/edge_grid.h"

namespace roevo::bench {
namespace {

void gradient(benchmark::State& state) {
    const cv::Mat& grey = room().frames.front().grey;
    Gradient out;
    for (auto _ : state) {
        computeGradient(grey, OdometryOptions().edges.blur_sigma, out);
        benchmark::DoNotOptimize(out.magnitude.data);
        benchmark::ClobberMemory();
    }
}
BENCHMARK(gradient)->Unit(benchmark::kMicrosecond);

void otsu(benchmark::State& state) {
    const cv::Mat& magnitude = room().gradient.magnitude;
    for (auto _ : state) benchmark::DoNotOptimize(otsuThreshold(magnitude));
}
BENCHMARK(otsu)->Unit(benchmark::kMicrosecond);

void cannyMask(benchmark::State& state) {
    EdgeMask out;
    for (auto _ : state) {
        canny(room().gradient, room().thresholds, out);
        benchmark::DoNotOptimize(out.pixels.data());
        benchmark::ClobberMemory();
    }
    state.counters["pixels"] = static_cast<double>(out.pixels.size());
}
BENCHMARK(cannyMask)->Unit(benchmark::kMicrosecond);

void organize(benchmark::State& state) {
    const EdgeOptions options;
    EdgeMask mask = {room().raw_mask.mask.clone(), room().raw_mask.pixels};
    adjustAdjacency(mask);
    EdgeOrganizer organizer;
    OrganizedEdges out;
    for (auto _ : state) {
        organizer.organize(room().gradient, mask, options.angle_deg, options.min_length, out);
        benchmark::DoNotOptimize(out.x.data());
        benchmark::ClobberMemory();
    }
    state.counters["edges"] = out.numEdges();
    state.counters["points"] = static_cast<double>(out.size());
}
BENCHMARK(organize)->Unit(benchmark::kMicrosecond);

void edgeExtractor(benchmark::State& state) {
    const cv::Mat& grey = room().frames.front().grey;
    EdgeExtractor extractor{EdgeOptions()};
    OrganizedEdges out;
    EdgeMask mask;
    for (auto _ : state) {
        extractor.extract(grey, out, mask);
        benchmark::DoNotOptimize(out.x.data());
        benchmark::ClobberMemory();
    }
}
BENCHMARK(edgeExtractor)->Unit(benchmark::kMicrosecond);

/// What a user of OpenCV would pay for unordered edge pixels alone, with the same thresholds.
void openCvCanny(benchmark::State& state) {
    const cv::Mat& grey = room().frames.front().grey;
    cv::Mat out;
    for (auto _ : state) {
        cv::Canny(grey, out, room().thresholds.low, room().thresholds.high, 3, true);
        benchmark::DoNotOptimize(out.data);
        benchmark::ClobberMemory();
    }
}
BENCHMARK(openCvCanny)->Unit(benchmark::kMicrosecond);

void edgeDepth(benchmark::State& state) {
    const OdometryOptions options;
    for (auto _ : state) {
        const EdgePoints3D lifted = liftEdges(room().edges, room().frames.front().depth, room().camera,
                                              RowMotion(), options.edges, options.sensor);
        benchmark::DoNotOptimize(lifted.points.x.data());
    }
}
BENCHMARK(edgeDepth)->Unit(benchmark::kMicrosecond);

void gridBuild(benchmark::State& state) {
    EdgeGrid grid;
    for (auto _ : state) {
        grid.build(room().edges, room().camera.width, room().camera.height);
        benchmark::ClobberMemory();
    }
}
BENCHMARK(gridBuild)->Unit(benchmark::kMicrosecond);

/// Every second edge point, moved aside, looks for a neighbour whose normal agrees: as association does.
void gridQueries(benchmark::State& state) {
    const OrganizedEdges& edges = room().edges;
    EdgeGrid grid;
    grid.build(edges, room().camera.width, room().camera.height);
    const auto radius = static_cast<double>(state.range(0));
    constexpr double kMinCosine = 0.9962;  // 5 degrees
    EdgeQueries queries;
    for (std::size_t i = 0; i < edges.size(); i += 2) {
        queries.u.push_back(edges.x[i] + 1.3F);
        queries.v.push_back(edges.y[i] - 0.7F);
        queries.normal_x.push_back(edges.normal_x[i]);
        queries.normal_y.push_back(edges.normal_y[i]);
    }
    std::vector<std::int32_t> nearest(queries.u.size());
    for (auto _ : state) {
        grid.nearest(queries, nearest.size(), radius, kMinCosine, nearest.data());
        benchmark::DoNotOptimize(nearest.data());
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(nearest.size()));
}
BENCHMARK(gridQueries)->ArgName("radius")->Arg(3)->Arg(6)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace roevo::bench
