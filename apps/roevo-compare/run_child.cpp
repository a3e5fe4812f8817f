#include "run_child.h"

#include <algorithm>
#include <new>
#include <opencv2/core/utility.hpp>

#include "programs/program.h"
#include "recordings/frame_source.h"
#include "run_method.h"
#include "run_progress.h"

namespace roevo {
namespace {

MethodInfo infoOf(const std::string& name) {
    const auto methods = knownMethods();
    const auto found =
        std::find_if(methods.begin(), methods.end(), [&](const MethodInfo& m) { return m.name == name; });
    return found == methods.end() ? MethodInfo() : *found;
}

MethodRun makeRun(const ChildSettings& settings, const RunProgress& progress) {
    cv::setNumThreads(1);
    const auto source = openSource(settings.input, settings.choice);
    const auto method = makeMethod(settings.method, source->camera(), settings.options);
    skipFrames(*source, settings.skip, settings.input);
    return runMethod(*method, infoOf(settings.method), *source, settings.first, settings.folder, progress);
}

void keepFailure(const ChildSettings& settings, const std::string& reason) {
    MethodRun run;
    run.method = settings.method;
    run.failure = reason;
    try {
        writeMethodRun(settings.folder, run);
    } catch (const std::exception&) {  // the reason is told all the same, as this process's last words
    }
}

}  // namespace

void runChild(const ChildSettings& settings) {
    try {
        const ProgressFile file(settings.folder);
        const auto tell = [&](std::size_t frames, double share) { file.write({frames, share}); };
        writeMethodRun(settings.folder, makeRun(settings, tell));
    } catch (const std::bad_alloc&) {
        keepFailure(settings, "out of memory");
        throw;
    } catch (const std::exception& e) {
        keepFailure(settings, firstLine(e.what()));
        throw;
    }
}

}  // namespace roevo
