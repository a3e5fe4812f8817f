#pragma once
/// Pixels in: the one place where image files are decoded and converted, shared by rawlogs and dataset
/// folders so that both give the odometry the same bytes.

#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace roevo {

/// Decodes an image file as 8-bit grey or BGR, whichever the file holds (an alpha channel is dropped).
/// @throws std::runtime_error naming the file when it is missing or cannot be decoded.
cv::Mat readColourFile(const std::string& file);

/// Decodes a 16-bit depth PNG. @return CV_16UC1.
/// @throws std::runtime_error naming the file when it is missing, cannot be decoded or is not 16-bit with one
/// channel.
cv::Mat readDepthFile(const std::string& file);

/// Decodes a depth image that holds 16-bit numbers (PNG, TIFF, PGM, NPY) or floats (TIFF, EXR, NPY), told by
/// its bytes. @return CV_16UC1 or CV_32FC1, as stored
/// @throws std::runtime_error as readDepthFile() does
cv::Mat readAnyDepthFile(const std::string& file);

/// What readColourFile() and readDepthFile() do for an image file's bytes that are elsewhere, with a name for
/// errors.
cv::Mat decodeColour(std::string_view bytes, const std::string& name);
cv::Mat decodeDepth(std::string_view bytes, const std::string& name);

/// Writes an image in the format of the file's ending. @param parameters  as cv::imwrite() has them
/// @throws std::runtime_error naming the file when not all of it could be written: cv::imwrite() does not
/// tell.
void writeImageFile(const std::string& file, const cv::Mat& image, const std::vector<int>& parameters = {});

/// Metres per unit for a depth image of `units_per_metre`, as the float that every reader multiplies with.
float depthUnit(double units_per_metre);

/// Depth in metres: float(value) * unit. @param depth_u16 CV_16UC1, 0 where unknown  @return CV_32FC1
cv::Mat depthToMetres(const cv::Mat& depth_u16, float unit);

/// 8-bit grey of an 8-bit image with one (shared, not copied), three (BGR) or four (BGRA) channels.
/// @throws std::runtime_error for any other type.
cv::Mat toGrey(const cv::Mat& image);

}  // namespace roevo
