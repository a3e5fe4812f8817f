#pragma once

namespace roevo {

/// Largest resident memory of this process so far, MB; 0 when the system does not tell.
double memoryPeakMb();

}  // namespace roevo
