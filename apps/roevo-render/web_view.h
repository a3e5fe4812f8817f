#pragma once
#include <string>
#include <vector>

#include "result_folder.h"
#include "view_paths.h"

namespace roevo {

/// A 3-D view as one HTML page that needs nothing else, and what to tell the user about it.
struct WebView {
    std::string html;
    std::size_t edge_points = 0, surface_points = 0;  ///< that are in it
    std::vector<std::string> notes;                   ///< what was left out
};

struct WebViewSettings {
    std::string name = "final";     ///< of the result's own trajectory
    std::vector<NamedPath> others;  ///< trajectories of other programs
    NamedPath truth;                ///< may be empty
    double max_size_mb = 15;        ///< 10^6 bytes; points are left out of what would be larger
};

/// @throws std::runtime_error when trajectories cannot be aligned, or the size is too small for them
WebView makeWebView(const ResultFolder& result, const WebViewSettings& settings);

}  // namespace roevo
