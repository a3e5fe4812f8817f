#pragma once
/// Every option of the odometry, one flat struct per stage, with unit and range. The same table serves config files,
/// `--set`, config_used.ini, --help and the checks.

#include <string>
#include <variant>
#include <vector>

namespace roevo {

enum class Mode { kCoarse, kTracking };  ///< paper's ct and tr

struct SensorOptions {
    double depth_weight_k = 0.5;     ///< Eq. (20), 1/m
    double min_depth = 0.15;         ///< Eq. (20) d_min, m; nearer depths are not used
    double max_depth = 8.0;          ///< farther depths are not used, m
};

struct OdometryOptions {
    Mode mode = Mode::kTracking;
    SensorOptions sensor;
};

/// One entry of the option table: where it lives, what it means, and a pointer into a given OdometryOptions.
struct OptionField {
    std::string section, key;
    std::string unit;         ///< "" when dimensionless
    std::string description;  ///< one sentence
    double min = 0, max = 0;  ///< inclusive range (unused for bool and mode)
    std::variant<double*, int*, bool*, Mode*> value;

    std::string name() const { return section + "." + key; }
    std::string toText() const;
    /// Parses text into the option. Returns an empty string, or one line naming the option, the text and the fault.
    std::string fromText(const std::string& text) const;
    /// Empty when the present value is in range, else one line naming the option, its value and the range.
    std::string check() const;
};

/// The table over `options`; the pointers live as long as `options`.
std::vector<OptionField> optionFields(OdometryOptions& options);

/// Sets one option by "section.key". Returns an empty string or one line of error (an unknown key names the closest known one).
std::string setOption(OdometryOptions& options, const std::string& name, const std::string& text);

/// Empty when all options are in range, else the first fault in one line.
std::string checkOptions(const OdometryOptions& options);

const char* toString(Mode mode);

}  // namespace roevo
