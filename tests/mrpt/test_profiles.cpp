// The sensor profiles in config_ini/: what they set, and that they hold nothing else.
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFile.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "roevo_mrpt/config_file.h"
#include "roevo_mrpt/roevo_odometry.h"

namespace roevo {
namespace {

struct Weight {
    double k, min_depth, max_depth;
};

// The paper's values in the paragraph of Eq. (20); for the D400, whose values it does not give, what the
// profile says of its own.
const std::map<std::string, Weight> kProfiles{{"kinect1", {0.75, 0.2, 4.5}},
                                              {"xtion", {0.75, 0.2, 4.5}},
                                              {"icl_nuim", {0.5, 0.1, 6}},
                                              {"eth3d", {0.5, 0.15, 5}},
                                              {"realsense_d400", {0.5, 0.3, 6}}};

const std::filesystem::path kFolder = std::filesystem::path(ROEVO_SOURCE_DIR) / "config_ini";

OdometryOptions load(const std::string& name) {
    OdometryOptions options;
    loadConfigFile((kFolder / (name + ".ini")).string(), options);
    return options;
}

TEST(Profiles, SetThePapersDepthWeight) {
    for (const auto& [name, weight] : kProfiles) {
        const SensorOptions sensor = load(name).sensor;
        EXPECT_EQ(sensor.depth_weight_k, weight.k) << name;
        EXPECT_EQ(sensor.min_depth, weight.min_depth) << name;
        EXPECT_EQ(sensor.max_depth, weight.max_depth) << name;
    }
}

TEST(Profiles, ChangeNothingElse) {
    const std::set<std::string> allowed{"sensor.depth_weight_k", "sensor.min_depth", "sensor.max_depth"};
    OdometryOptions defaults;
    const auto usual = optionFields(defaults);
    for (const auto& [name, weight] : kProfiles) {
        OdometryOptions options = load(name);
        const auto fields = optionFields(options);
        for (std::size_t i = 0; i < fields.size(); i++)
            EXPECT_TRUE(fields[i].toText() == usual[i].toText() || allowed.count(fields[i].name()) == 1)
                << name << " sets " << fields[i].name();
    }
}

// Applied on top of roevo.ini, a profile must do what it does alone.
TEST(Profiles, EveryLineDiffersFromTheDefault) {
    for (const auto& entry : kProfiles) {
        OdometryOptions defaults, options = load(entry.first);
        const auto usual = optionFields(defaults), fields = optionFields(options);
        std::size_t changed = 0;
        for (std::size_t i = 0; i < fields.size(); i++)
            if (fields[i].toText() != usual[i].toText()) changed++;
        std::ifstream in(kFolder / (entry.first + ".ini"));
        std::size_t lines = 0;
        for (std::string line; std::getline(in, line);)
            if (!line.empty() && line[0] != ';' && line.find('=') != std::string::npos) lines++;
        EXPECT_EQ(lines, changed) << entry.first;
    }
}

TEST(Profiles, NoOtherFileIsThere) {
    for (const auto& file : std::filesystem::directory_iterator(kFolder)) {
        const std::string name = file.path().stem().string();
        EXPECT_TRUE(name == "roevo" || name == "mrpt_application" || kProfiles.count(name) == 1)
            << file.path();
    }
}

TEST(Profiles, TheFileForMrptsApplicationsNamesDefaults) {
    const mrpt::config::CConfigFile config((kFolder / "mrpt_application.ini").string());
    for (const char* key : {"rawlog_file", "logOutput_dir"})
        EXPECT_TRUE(config.keyExists("MappingApplication", key)) << key;
    CRoevoOdometry::TOptions options;
    options.odometry.mode = Mode::kTracking;
    options.odometry.sensor.max_depth = 1;
    options.loadFromConfigFile(config, "CRoevoOdometry");
    OdometryOptions defaults;
    const auto usual = optionFields(defaults), fields = optionFields(options.odometry);
    for (std::size_t i = 0; i < fields.size(); i++) EXPECT_EQ(fields[i].toText(), usual[i].toText());
}

}  // namespace
}  // namespace roevo
