#include <mrpt/config/CConfigFileBase.h>

#include <ostream>
#include <set>
#include <stdexcept>

#include "roevo_mrpt/config_file.h"
#include "roevo_mrpt/roevo_odometry.h"

namespace roevo {
namespace {

std::string prefixOf(const std::string& section) {
    return section.empty() ? "" : section + ".";
}

}  // namespace

void CRoevoOdometry::TOptions::loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                                                  const std::string& section) {
    OdometryOptions changed = odometry;
    std::set<std::string> sections;
    for (const OptionField& field : optionFields(changed)) sections.insert(field.section);
    std::vector<std::string> all;
    if (!section.empty()) source.getAllSections(all);  // without a section, others' stand beside ours
    for (const std::string& full : all) {
        const bool ours = full.rfind(prefixOf(section), 0) == 0;
        std::vector<std::string> keys;
        source.getAllKeys(full, keys);
        if (keys.empty() || (full != section && !ours)) continue;
        if (full == section || sections.count(full.substr(section.size() + 1)) == 0)
            throw std::runtime_error("[" + full + "]: no options stand here, but in sections like [" +
                                     section + "." + *sections.begin() + "]");
    }
    for (const std::string& name : sections) {
        const std::string full = prefixOf(section) + name;
        std::vector<std::string> keys;
        source.getAllKeys(full, keys);
        for (const std::string& key : keys) {
            const std::string fault = setOption(changed, name + "." + key, source.read_string(full, key, ""));
            if (!fault.empty()) throw std::runtime_error("[" + full + "]: " + fault);
        }
    }
    if (const std::string fault = checkOptions(changed); !fault.empty()) throw std::runtime_error(fault);
    odometry = changed;
}

void CRoevoOdometry::TOptions::saveToConfigFile(mrpt::config::CConfigFileBase& target,
                                                const std::string& section) const {
    OdometryOptions copy = odometry;
    for (const OptionField& field : optionFields(copy)) {
        const std::string unit = field.unit.empty() ? "" : ", " + field.unit;
        target.write(prefixOf(section) + field.section, field.key, field.toText(), -1, -1,
                     field.description + unit);
    }
}

void CRoevoOdometry::TOptions::dumpToTextStream(std::ostream& out) const {
    out << "---------- [CRoevoOdometry::TOptions] ----------\n" << toConfigText(odometry);
}

}  // namespace roevo
