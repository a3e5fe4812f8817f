#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "recordings/frame_source.h"

namespace roevo {

/// Another source as it is: for sources that change a part of it.
class ForwardingSource : public FrameSource {
  public:
    explicit ForwardingSource(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

    bool next(SourceFrame& frame) override { return source_->next(frame); }
    bool skip() override { return source_->skip(); }
    const PinholeCamera& camera() const override { return source_->camera(); }
    std::string kind() const override { return source_->kind(); }
    std::string cameraSource() const override { return source_->cameraSource(); }
    GroundTruth groundTruth() const override { return source_->groundTruth(); }
    std::vector<std::string> notes() const override { return source_->notes(); }
    std::size_t size() const override { return source_->size(); }
    std::string warning() const override { return source_->warning(); }

  protected:
    const FrameSource& source() const { return *source_; }

  private:
    std::unique_ptr<FrameSource> source_;
};

}  // namespace roevo
