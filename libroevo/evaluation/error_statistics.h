#pragma once
#include <cstddef>
#include <vector>

namespace roevo {

/// What a list of errors comes to, in the unit of the errors. `std` is of the population (divided by N).
struct ErrorStatistics {
    double rmse = 0, mean = 0, median = 0, std = 0, min = 0, max = 0;
    std::size_t count = 0;  ///< 0: nothing to measure, and the figures mean nothing
};

ErrorStatistics errorStatistics(std::vector<double> errors);

/// Value below which the share `p` (0..1) of `values` lies, linear between neighbours; 0 for an empty list.
double percentile(std::vector<double> values, double p);

}  // namespace roevo
