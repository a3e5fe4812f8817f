#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare.h"
#include "kept_run.h"
#include "queue_display.h"
#include "run_queue.h"

namespace roevo {

/// The runs of a comparison, by sequence and method, as they come in.
class Runs : public QueueObserver {
  public:
    /// Finds what is there already, if it may be taken again.
    /// @param sequences  opened, in the order of the settings'; both outlive this object
    Runs(const CompareSettings& settings, std::vector<SequenceComparison>& sequences);

    /// Makes what is still to be made.
    /// @param config  file with the options in force
    /// @throws as runTasks()
    void make(const std::string& config);

    void finished(std::size_t task, const MethodRun& run, double seconds) override {
        ++made_;
        place_[where_[task].first][where_[task].second] = run;
        display_.finished(task, run, seconds);
    }
    void going(const std::map<std::size_t, double>& running) override { display_.going(running); }

    /// Puts all runs that there are into the sequences, in the order of the methods.
    void deliver();

    std::size_t count() const;  ///< runs that there are, without skipped methods
    std::size_t total() const;  ///< runs that there should be
    std::size_t left() const { return tasks_.size() - made_; }  ///< that are still to be made
    std::size_t reused() const { return reused_; }              ///< runs that are not made anew

  private:
    MethodRun notRun(std::size_t s, std::size_t m, const std::string& reason) const;
    void plan(std::size_t s, std::size_t m, const std::map<std::string, std::string>& run_settings);
    void tell(const RunTask& task, const KeptRun& kept) const;
    std::string folder(std::size_t s, std::size_t m) const;

    const CompareSettings& settings_;
    std::vector<SequenceComparison>& sequences_;
    std::vector<std::vector<std::optional<MethodRun>>> place_;
    std::vector<RunTask> tasks_;
    std::vector<std::pair<std::size_t, std::size_t>> where_;  // of each task: sequence, method
    std::size_t reused_ = 0, made_ = 0;
    QueueDisplay display_{tasks_, !settings_.quiet};
};

}  // namespace roevo
