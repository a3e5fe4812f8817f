#include "evaluation/error_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace roevo {

double percentile(std::vector<double> values, double p) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    const double position = p * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(position);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (position - static_cast<double>(below)) * (values[above] - values[below]);
}

ErrorStatistics errorStatistics(std::vector<double> errors) {
    ErrorStatistics s;
    s.count = errors.size();
    if (errors.empty()) return s;
    const double n = static_cast<double>(errors.size());
    s.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / n;
    const double square_sum = std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0);
    s.rmse = std::sqrt(square_sum / n);
    double spread = 0;
    for (const double e : errors) spread += (e - s.mean) * (e - s.mean);
    s.std = std::sqrt(spread / n);
    const auto [low, high] = std::minmax_element(errors.begin(), errors.end());
    s.min = *low;
    s.max = *high;
    s.median = percentile(std::move(errors), 0.5);
    return s;
}

}  // namespace roevo
