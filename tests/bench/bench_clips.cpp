// The extraction of edges beside cv::Canny, on the images of real clips. Skips, visibly, without the data.
#include <benchmark/benchmark.h>

#include <opencv2/core/utility.hpp>
#include <opencv2/core/utils/filesystem.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "edges/edge_extractor.h"
#include "support/data_folder.h"

namespace roevo::bench {
namespace {

struct Image {
    cv::Mat grey;
    CannyThresholds thresholds;  ///< ours
};

std::vector<Image> imagesOf(const std::string& clip) {
    const EdgeOptions options;
    Gradient gradient;
    std::vector<Image> images;
    std::vector<cv::String> files;
    for (const char* pattern : {"/rgb/*.png", "/rgb/*.jpg"}) {
        if (!files.empty() || !cv::utils::fs::isDirectory(test::dataFolder() + "/" + clip)) break;
        cv::glob(test::dataFolder() + "/" + clip + pattern, files);
    }
    for (const cv::String& file : files) {
        Image image;
        image.grey = cv::imread(file, cv::IMREAD_GRAYSCALE);
        computeGradient(image.grey, options.blur_sigma, gradient);
        image.thresholds = cannyThresholds(gradient, options);
        images.push_back(image);
    }
    return images;
}

/// Mean time of an image.
template <class Extract>
void timeEach(benchmark::State& state, const std::string& clip, const Extract& extract) {
    cv::setNumThreads(1);
    const std::vector<Image> images = imagesOf(clip);
    if (images.empty()) return state.SkipWithError(("no clip " + clip).c_str());
    for (auto _ : state)
        for (const Image& image : images) extract(image);
    state.counters["per_image"] =
        benchmark::Counter(static_cast<double>(images.size()),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void clipEdges(benchmark::State& state, const std::string& clip) {
    EdgeExtractor extractor{EdgeOptions()};
    OrganizedEdges edges;
    EdgeMask mask;
    timeEach(state, clip, [&](const Image& image) {
        extractor.extract(image.grey, edges, mask);
        benchmark::DoNotOptimize(edges.x.data());
    });
}

void clipOpenCvCanny(benchmark::State& state, const std::string& clip) {
    cv::Mat out;
    timeEach(state, clip, [&](const Image& image) {
        cv::Canny(image.grey, out, image.thresholds.low, image.thresholds.high, 3, true);
        benchmark::DoNotOptimize(out.data);
    });
}

#define ROEVO_BENCH_CLIP(name, clip)                                                      \
    BENCHMARK_CAPTURE(clipEdges, name, std::string(clip))->Unit(benchmark::kMillisecond); \
    BENCHMARK_CAPTURE(clipOpenCvCanny, name, std::string(clip))->Unit(benchmark::kMillisecond)

ROEVO_BENCH_CLIP(fr1_xyz, "tum_fr1_xyz_150");
ROEVO_BENCH_CLIP(fr1_rpy, "tum_fr1_rpy_100");
ROEVO_BENCH_CLIP(fr3_structure_notexture_far, "tum_fr3_structure_notexture_far_80");
ROEVO_BENCH_CLIP(icl_office_kt0, "icl_office_kt0_50");

}  // namespace
}  // namespace roevo::bench
