#pragma once
#include <string>
#include <vector>

#include "efficiency.h"

namespace roevo {

/// The two registrations side by side, as they are and reduced to the same work: efficiency_registration.csv
/// and .svg, and notes that say exactly what each does.
/// @param together  all recordings as one, for the summary
/// @return for the summary, one clause
std::string reportRegistrations(StudyReport& report, const std::string& folder,
                                const std::vector<Measured>& all, const Measured& together,
                                const FineOptions& options);

}  // namespace roevo
