#include "run_child.h"

#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <opencv2/core/utility.hpp>

#include "given_trajectory.h"
#include "programs/program.h"
#include "recordings/frame_source.h"
#include "rows.h"
#include "run_method.h"
#include "run_progress.h"

namespace roevo {
namespace {

// What it allocates, not its address space: libraries reserve much more of that than they ever touch.
void limitMemory(double mb) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    mb = 0;  // sanitizers map terabytes before anything runs
#endif
    if (mb <= 0) return;
    const auto bytes = static_cast<rlim_t>(mb * 1e6);
    const rlimit limit{bytes, bytes};
    if (setrlimit(RLIMIT_DATA, &limit) != 0)
        throw std::runtime_error(std::string("cannot limit the memory: ") + std::strerror(errno));
}

MethodRun runGiven(const ChildSettings& settings, const SequenceComparison& sequence, FrameSource& source,
                   const RunProgress& progress) {
    GivenTrajectory given(settings.trajectory, readGivenTrajectory(settings.trajectory, sequence.reference,
                                                                   sequence.ground_truth));
    MethodRun run = runMethod(given, {}, source, settings.sequence.first, settings.folder, progress);
    run.trajectory_file = settings.trajectory;
    forgetCosts(run);
    return run;
}

MethodRun makeRun(const ChildSettings& settings, const SequenceComparison& sequence, FrameSource& source,
                  const RunProgress& progress) {
    const std::string name = settings.method.substr(0, settings.method.find(kVariantMark));
    skipFrames(source, settings.sequence.skip, settings.sequence.input);
    if (!settings.trajectory.empty()) return runGiven(settings, sequence, source, progress);
    const auto method = makeMethod(name, source.camera(), settings.options);
    return runMethod(*method, {}, source, settings.sequence.first, settings.folder, progress);
}

void keepFailure(const ChildSettings& settings, SequenceComparison row, const std::string& part,
                 const std::string& reason) {
    row.name = settings.sequence.name;
    row.runs.resize(1);
    row.runs[0] = MethodRun();
    row.runs[0].method = settings.method;
    row.runs[0].failure = reason;
    row.runs[0].part = part;
    try {
        writeRow(settings.folder, row);
    } catch (const std::exception&) {  // the reason is told all the same, as this process's last words
    }
}

std::string outOfMemory(const ChildSettings& settings) {
    char text[64] = "out of memory";
    if (settings.memory_mb > 0)
        std::snprintf(text, sizeof text, "out of memory: more than %g MB", settings.memory_mb);
    return text;
}

}  // namespace

void runChild(const ChildSettings& settings) {
    SequenceComparison row;
    std::string part;
    try {
        cv::setNumThreads(1);  // before memory is limited: TBB waits forever where it gets none
        limitMemory(settings.memory_mb);
        row = openSequence(settings.sequence);
        if (!row.failure.empty()) throw std::runtime_error(row.failure);
        const ProgressFile file(settings.folder);
        const auto tell = [&](std::size_t frames, double share) { file.write({frames, share}); };
        const auto source = openSource(settings.sequence.input, settings.sequence.choice);
        part = partOf(settings.sequence, source->size());
        row.runs = {makeRun(settings, row, *source, tell)};
        MethodRun& run = row.runs[0];
        run.method = settings.method;
        run.poses = run.trajectory.size();
        // A rawlog does not tell its length before its end
        if (source->isAtEnd()) part = partOf(settings.sequence, settings.sequence.skip + run.frames);
        run.part = part;
        writeRow(settings.folder, row);
    } catch (const std::exception& e) {
        const std::string reason = isOutOfMemory(e) ? outOfMemory(settings) : describe(e);
        keepFailure(settings, row, part, reason);
        throw;
    }
}

}  // namespace roevo
