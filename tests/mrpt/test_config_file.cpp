#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>

#include <fstream>
#include <sstream>

#include "mrpt/test_helpers.h"
#include "roevo_mrpt/config_file.h"
#include "roevo_mrpt/roevo_odometry.h"

namespace roevo {
namespace {

using test::countEntries;
using test::errorOf;

std::vector<std::string> values(OdometryOptions options) {
    std::vector<std::string> out;
    for (const OptionField& field : optionFields(options)) out.push_back(field.name() + "=" + field.toText());
    return out;
}

/// Options that all differ from their defaults.
OdometryOptions unusual() {
    OdometryOptions options;
    for (const OptionField& field : optionFields(options)) {
        if (auto* const* number = std::get_if<double*>(&field.value))
            **number = 0.5 * (**number + field.max) + 1e-7;
        if (auto* const* whole = std::get_if<int*>(&field.value)) **whole += **whole < field.max ? 1 : -1;
        if (auto* const* flag = std::get_if<bool*>(&field.value)) **flag = !**flag;
        if (auto* const* mode = std::get_if<Mode*>(&field.value)) **mode = Mode::kCoarse;
    }
    options.sensor.min_depth = 0.3;
    options.sensor.max_depth = 4.5;
    return options;
}

TEST(ConfigFile, RoundTripsEveryOption) {
    const test::TemporaryFolder folder;
    const OdometryOptions options = unusual();
    ASSERT_EQ(checkOptions(options), "");
    ASSERT_NE(values(options), values({}));
    saveConfigFile(folder / "config.ini", options);
    EXPECT_EQ(countEntries(folder.path()), 1);
    OdometryOptions read;
    loadConfigFile(folder / "config.ini", read);
    EXPECT_EQ(values(read), values(options));
}

TEST(ConfigFile, SaysWhyItCannotBeWrittenAndKeepsWhatLiesBesideIt) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(errorOf([&] { saveConfigFile(folder / "no/a.ini", {}); }),
              "cannot write " + folder / "no/a.ini" + ": No such file or directory");
    test::writeFile(folder / "a.ini.part", "mine");
    saveConfigFile(folder / "a.ini", {});
    EXPECT_EQ(test::readFile(folder / "a.ini.part"), "mine");
    EXPECT_EQ(countEntries(folder.path()), 2);
}

TEST(ConfigFile, SaysUnitRangeAndMeaningOfEveryOption) {
    OdometryOptions options;
    const std::string text = toConfigText(options);
    for (const OptionField& field : optionFields(options)) {
        EXPECT_NE(text.find("[" + field.section + "]"), std::string::npos);
        EXPECT_NE(text.find("\n" + field.key + " = " + field.toText() + "\n"), std::string::npos)
            << field.name();
        EXPECT_NE(text.find(field.description), std::string::npos) << field.name();
    }
}

TEST(ConfigFile, AcceptsCommentsBlanksAndWindowsLineEnds) {
    OdometryOptions options;
    loadConfigText(
        "; note\r\n\r\n# more\r\n[ sensor ]\r\n  max_depth =  3.5   // metres\r\n\tmin_depth=0.25;near\r\n",
        "x.ini", options);
    EXPECT_EQ(options.sensor.max_depth, 3.5);
    EXPECT_EQ(options.sensor.min_depth, 0.25);
    loadConfigText("\xEF\xBB\xBF[sensor]\r\nmax_depth = 4.5\r\n", "x.ini", options);
    EXPECT_EQ(options.sensor.max_depth, 4.5);
}

TEST(ConfigFile, ErrorsNameFileLineAndClosestKey) {
    OdometryOptions options;
    const auto error = [&](const std::string& text) {
        return errorOf([&] { loadConfigText(text, "x.ini", options); });
    };
    const std::string unknown = error("[sensor]\nmin_depth = 0.3\nmax_deph = 3\n");
    EXPECT_NE(unknown.find("x.ini:3"), std::string::npos) << unknown;
    EXPECT_NE(unknown.find("'sensor.max_depth'"), std::string::npos) << unknown;
    EXPECT_NE(error("[sensor]\nmax_depth = far\n").find("far"), std::string::npos);
    EXPECT_NE(error("[sensor]\nmax_depth = 1e9\n").find("outside"), std::string::npos);
    EXPECT_NE(error("[sensor]\nmax_depth 3\n").find("x.ini:2: expected 'key = value'"), std::string::npos);
    EXPECT_EQ(error("[sensor]\nmax_depth = 3\n[fine]\n[sensor]\nmax_depth = 4\n"),
              "x.ini:5: sensor.max_depth stands here again, first in line 2");
    EXPECT_EQ(values(options), values({})) << "a faulty file must change nothing";
    EXPECT_NE(errorOf([&] { loadConfigFile("/nowhere/x.ini", options); }).find("/nowhere/x.ini"),
              std::string::npos);
}

TEST(ConfigFile, MrptOptionsRoundTripWithAndWithoutASection) {
    for (const std::string section : {"", "front"}) {
        CRoevoOdometry::TOptions out, in;
        out.odometry = unusual();
        mrpt::config::CConfigFileMemory file;
        out.saveToConfigFile(file, section);
        in.loadFromConfigFile(file, section);
        EXPECT_EQ(values(in.odometry), values(out.odometry));
        file.write(section.empty() ? "sensor" : section + ".sensor", "max_deph", 3);
        EXPECT_NE(errorOf([&] { in.loadFromConfigFile(file, section); }).find("'sensor.max_depth'"),
                  std::string::npos);
    }
    for (const char* elsewhere : {"front", "front.fien"}) {
        mrpt::config::CConfigFileMemory file;
        file.write(elsewhere, "mode", "tr");
        file.write("back", "mode", "somebody else's");
        CRoevoOdometry::TOptions in;
        EXPECT_NE(
            errorOf([&] { in.loadFromConfigFile(file, "front"); }).find("[" + std::string(elsewhere) + "]"),
            std::string::npos);
    }
    std::ostringstream text;
    CRoevoOdometry::TOptions().dumpToTextStream(text);
    EXPECT_NE(text.str().find("max_depth"), std::string::npos);
}

}  // namespace
}  // namespace roevo
