#include "run_child.h"

#include <algorithm>
#include <cstdio>
#include <opencv2/core/utility.hpp>

#include "recording/frame_source.h"
#include "run_method.h"

namespace roevo {
namespace {

MethodInfo infoOf(const std::string& name) {
    const auto methods = knownMethods();
    const auto found =
        std::find_if(methods.begin(), methods.end(), [&](const MethodInfo& m) { return m.name == name; });
    return found == methods.end() ? MethodInfo() : *found;
}

}  // namespace

void runChild(const ChildSettings& settings) {
    cv::setNumThreads(1);
    const auto source = openSource(settings.input, settings.sensor_label);
    const auto method = makeMethod(settings.method, source->camera(), settings.options);
    skipFrames(*source, settings.skip, settings.input);

    const auto tell = [](std::size_t frames, double share) {
        std::printf("%zu %.4f\n", frames, share);
        std::fflush(stdout);  // a buffered line would be lost if the method took the process down with it
    };
    const MethodRun run =
        runMethod(*method, infoOf(settings.method), *source, settings.first, settings.folder, tell);
    writeMethodRun(settings.folder, run);
}

}  // namespace roevo
