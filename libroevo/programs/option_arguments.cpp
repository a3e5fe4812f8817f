#include "programs/option_arguments.h"

#include "programs/program.h"
#include "roevo_mrpt/config_file.h"

namespace roevo {

OdometryOptions collectOptions(const std::string& config_file, const std::vector<std::string>& settings,
                               const std::string& mode) {
    OdometryOptions options;
    if (!config_file.empty()) loadConfigFile(config_file, options);
    for (const std::string& setting : settings) {
        const std::size_t equals = setting.find('=');
        if (equals == std::string::npos)
            throw UsageError("--set: '" + setting + "' is not section.key=value");
        const std::string fault = setOption(options, setting.substr(0, equals), setting.substr(equals + 1));
        if (!fault.empty()) throw UsageError("--set: " + fault);
    }
    if (!mode.empty())
        if (const std::string fault = setOption(options, "odometry.mode", mode); !fault.empty())
            throw UsageError("--mode: " + fault);
    if (const std::string fault = checkOptions(options); !fault.empty()) throw UsageError(fault);
    return options;
}

}  // namespace roevo
