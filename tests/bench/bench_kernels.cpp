// The hot loops of the trackers: portable baseline against AVX2.
#include <benchmark/benchmark.h>

#include "bench/room.h"

namespace roevo::bench {
namespace {

/// The table that a benchmark's argument asks for, or nullptr after saying that there is none.
const kernels::Table* chosenTable(benchmark::State& state) {
    const kernels::Table* table = state.range(0) != 0 ? kernels::avx2() : &kernels::baseline();
    if (table == nullptr) {
        state.SkipWithError("this processor has no AVX2");
    } else {
        state.SetLabel(table->name);
    }
    return table;
}

Pose smallMotion() {
    Pose T = Pose::Identity();
    T.setRotation(Eigen::AngleAxisd(0.01, Eigen::Vector3d(0.3, 0.9, 0.1).normalized()).toRotationMatrix());
    T.translation() = Eigen::Vector3d(0.01, -0.004, 0.006);
    return T;
}

struct Projected {
    explicit Projected(std::size_t n) : x(n), y(n), z(n), u(n), v(n) {}
    std::vector<float> x, y, z, u, v;
    kernels::ProjectedPoints view() { return {x.data(), y.data(), z.data(), u.data(), v.data()}; }
};

void kernelProject(benchmark::State& state) {
    const kernels::Table* table = chosenTable(state);
    if (table == nullptr) return;
    const EdgePoints3D& points = room().points;
    const std::size_t n = points.points.x.size();
    Projected out(n);
    const kernels::Projection motion = makeProjection(smallMotion(), room().camera, RowMotion());
    for (auto _ : state) {
        table->project(motion, points.points.x.data(), points.points.y.data(), points.points.z.data(), n,
                       out.view());
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n));
}
BENCHMARK(kernelProject)->ArgName("avx2")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void kernelPatches(benchmark::State& state) {
    const kernels::Table* table = chosenTable(state);
    if (table == nullptr) return;
    const PhotometricPoints& points = room().photometric;
    const std::size_t n = points.size();
    Projected at(points.points.x.size());
    table->project(makeProjection(smallMotion(), room().camera, RowMotion()), points.points.x.data(),
                   points.points.y.data(), points.points.z.data(), points.points.x.size(), at.view());
    const cv::Mat& grey = room().frames.front().grey;
    const kernels::ImageView image{grey.ptr<std::uint8_t>(), static_cast<std::ptrdiff_t>(grey.step),
                                   grey.cols, grey.rows};
    std::vector<kernels::PatchResidual> out(n);
    for (auto _ : state) {
        table->patches(image, points.patches[0].data(), at.u.data(), at.v.data(), points.axis_x.data(),
                       points.axis_y.data(), n, 1, 0, out.data());
        benchmark::ClobberMemory();
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n));
}
BENCHMARK(kernelPatches)->ArgName("avx2")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void kernelAccumulate(benchmark::State& state) {
    const kernels::Table* table = chosenTable(state);
    if (table == nullptr) return;
    Points3 points = room().points.points;
    const std::size_t n = points.size();
    // The time does not depend on the values, as long as none is denormal
    std::vector<std::vector<float>> values;
    for (int i = 0; i < 9; ++i) values.emplace_back(n, 1.0F + 0.1F * static_cast<float>(i));
    kernels::InformationArrays rows{points.x.data(), points.y.data(), points.z.data(), {}, {}};
    for (std::size_t i = 0; i < 6; ++i) rows.matrix[i] = values[i].data();
    for (std::size_t i = 0; i < 3; ++i) rows.vector[i] = values[6 + i].data();
    kernels::NormalEquations out{};
    for (auto _ : state) {
        table->accumulate(rows, n, out);
        benchmark::DoNotOptimize(out);
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(n));
}
BENCHMARK(kernelAccumulate)->ArgName("avx2")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace roevo::bench
