#pragma once
#include <string>
#include <vector>

#include "recordings/dataset_reader.h"

namespace roevo {

/// Units per second of stamps, as their size tells: 1, 1e3, 1e6 or 1e9, the least by which none is after the
/// year 2100 (since 1970) and frames follow each other within 5 s; within an hour where they have decimals
/// and are of this century.
/// @param stamps  of the images of a recording, in any order
double unitOfStamps(std::vector<double> stamps);

/// The same of images of a dataset, which keeps the unit (`time_unit`) and notes another one than s.
double unitOfImages(std::vector<double> stamps, DatasetDescription& dataset);

/// Images that have no rate yet and whose stamps are whole numbers, too small for seconds since 1970: frames
/// at `rate` (Hz), or with 0 a warning that they were taken for seconds.
void settleCount(DatasetDescription& dataset, double rate);

/// Stamps that can only be ms, us or ns of this century become s, and `copyable` ends.
/// @return the unit: "ms", "us" or "ns"; empty: s, or not told
std::string toSeconds(GroundTruth& truth);

/// Median of the steps between stamps; 0 for fewer than two.
double medianStep(const std::vector<double>& ascending);

/// Whether it may be the number of a frame: whole, and not below 0.
bool isFrameNumber(double stamp);

/// Ground truth that counts frames at the images' rate gets seconds. @return whether it did count
bool numbersToSeconds(DatasetDescription& dataset);

/// Where the ground truth counts frames as the images do, or has times that have nothing in common with
/// theirs and are in another unit of the same clock: brings both to seconds, and says so. Times that have
/// nothing in common at all are said, too.
void settleClock(DatasetDescription& dataset);

}  // namespace roevo
