#pragma once
#include <memory>
#include <string>

#include "recordings/frame_source.h"

namespace roevo {

/// The same frames with a mask (see RgbdFrame::mask), and without depth where it is black.
/// @param mask  image file in the colour camera's pixels. Black is what is darker than half of its brightest.
/// @throws std::runtime_error when it cannot be read, has another size, leaves nothing, or leaves nothing out
std::unique_ptr<FrameSource> maskedFrames(std::unique_ptr<FrameSource> source, const std::string& mask);

}  // namespace roevo
