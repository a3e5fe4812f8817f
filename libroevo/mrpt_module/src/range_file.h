#pragma once
/// External range images of CObservation3DRangeScan.

#include <string>

namespace mrpt::obs {
class CObservation3DRangeScan;
}

namespace roevo {

/// Loads the scan's external range image from the folder with the rawlog's images. MRPT itself takes a file
/// that ends early for a whole one; here the range image stays empty when its file is missing or damaged.
void loadRangeFile(mrpt::obs::CObservation3DRangeScan& scan, const std::string& folder);

}  // namespace roevo
