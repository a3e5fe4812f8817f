#pragma once
#include <memory>
#include <string>

#include "recordings/frame_source.h"

namespace roevo {

/// The same frames with a mask (see RgbdFrame::mask), and without depth where it is black.
/// @param mask  image file of the colour camera's size, in its pixels: what is darker than half of its
/// brightest
///              pixel is left out
/// @throws std::runtime_error when it cannot be read, has another size or leaves nothing
std::unique_ptr<FrameSource> maskedFrames(std::unique_ptr<FrameSource> source, const std::string& mask);

}  // namespace roevo
