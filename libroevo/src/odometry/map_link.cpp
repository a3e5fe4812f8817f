#include "map_link.h"

#include "stopwatch.h"

namespace roevo {

void MapLink::submit(MapJob job, long frame) {
    thread_.submit(std::move(job));
    due_.push_back(frame + options_.latency);
}

std::optional<MapResult> MapLink::next(long frame, double& waited_ms) {
    if (due_.empty()) return std::nullopt;
    if (options_.deterministic ? due_.front() > frame : taken_.empty() && !thread_.ready())
        return std::nullopt;
    if (taken_.empty()) {
        const Stopwatch watch;
        taken_.push_back(thread_.take());
        waited_ms += watch.milliseconds();
    }
    due_.pop_front();
    MapResult result = std::move(taken_.front());
    taken_.pop_front();
    return result;
}

const std::deque<MapResult>& MapLink::outstanding() {
    while (thread_.pending() > 0) taken_.push_back(thread_.take());
    return taken_;
}

}  // namespace roevo
