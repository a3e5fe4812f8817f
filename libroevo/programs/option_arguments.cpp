#include "programs/option_arguments.h"

#include <CLI/CLI.hpp>
#include <charconv>

#include "programs/program.h"
#include "roevo_mrpt/config_file.h"

namespace roevo {

std::string faultOfNumber(const std::string& word) {
    constexpr double kMost = 1e12;
    double number = 0;
    const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (fault == std::errc() && end == word.data() + word.size() && number >= 0 && number <= kMost) return {};
    return "'" + word + "' is not a finite number from 0 to 1e12";
}

std::string faultOfCount(const std::string& word, std::size_t least) {
    std::size_t count = 0;
    const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), count);
    if (fault == std::errc() && end == word.data() + word.size() && count >= least) return {};
    return "'" + word + "' is not a whole number of " + std::to_string(least) + " or more";
}

void addFrameOptions(CLI::App& app, std::size_t& first, std::size_t& skip, const std::string& of) {
    app.add_option("--first", first, "Process at most this many frames" + of + " (default: all)")
        ->check([](const std::string& word) { return faultOfCount(word, 1); }, "");
    app.add_option("--skip", skip, "Leave out this many frames at the start" + of)
        ->check([](const std::string& word) { return faultOfCount(word, 0); }, "");
}

void addSetOption(CLI::App& app, std::vector<std::string>& settings) {
    app.add_option("--set", settings, "One option on top of the config; for several, give --set again")
        ->allow_extra_args(false)
        ->option_text("SECTION.KEY=VALUE");
}

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
