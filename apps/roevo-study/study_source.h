#pragma once
#include <cstddef>
#include <memory>

#include "recordings/frame_source.h"
#include "study.h"

namespace roevo {

/// Ends after this many frames.
std::unique_ptr<FrameSource> firstFrames(std::unique_ptr<FrameSource> source, std::size_t count);

/// Leaves out `count` frames after the first `first` ones.
std::unique_ptr<FrameSource> withoutFrames(std::unique_ptr<FrameSource> source, std::size_t first,
                                           std::size_t count);

/// Images and camera of another size. @param factor  of width and height
std::unique_ptr<FrameSource> resized(std::unique_ptr<FrameSource> source, double factor);

/// Notes what is wrong with a recording once it has been read to its end.
std::unique_ptr<FrameSource> watched(std::unique_ptr<FrameSource> source,
                                     std::shared_ptr<RecordingDamage> damage);

}  // namespace roevo
