// Option table: ranges, texts, faults in words.
#include <gtest/gtest.h>
#include <sched.h>

#include <cmath>
#include <limits>
#include <set>

#include "roevo/odometry.h"
#include "roevo/options.h"

namespace roevo {
namespace {

bool isNumber(const OptionField& field) {
    return std::holds_alternative<double*>(field.value) || std::holds_alternative<int*>(field.value);
}

double limit(const OptionField& field, bool upper) {
    return upper ? field.max : field.min;
}

void put(const OptionField& field, double value) {
    if (auto* const* real = std::get_if<double*>(&field.value)) **real = value;
    if (auto* const* whole = std::get_if<int*>(&field.value)) **whole = static_cast<int>(value);
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// Calls `check(options, field, upper)` for every number's lower and upper limit, with fresh default options.
template <class Check>
void forEveryLimit(Check&& check) {
    OdometryOptions reference;
    const std::size_t count = optionFields(reference).size();
    for (std::size_t i = 0; i < count; ++i) {
        for (const bool upper : {false, true}) {
            OdometryOptions options;
            const auto field = optionFields(options)[i];
            if (isNumber(field)) check(options, field, upper);
        }
    }
}

TEST(Options, DefaultsAreInRange) {
    EXPECT_EQ(checkOptions(OdometryOptions()), "");
}

TEST(Options, EveryFieldHasAUniqueNameAndADescription) {
    OdometryOptions options;
    std::set<std::string> names;
    std::set<const void*> places;
    for (const auto& field : optionFields(options)) {
        EXPECT_TRUE(names.insert(field.name()).second) << field.name();
        EXPECT_FALSE(field.description.empty()) << field.name();
        EXPECT_EQ(field.name(), field.section + "." + field.key);
        const void* place = std::visit([](auto* p) -> const void* { return p; }, field.value);
        EXPECT_TRUE(places.insert(place).second) << field.name() << " shares its place with another option";
        if (isNumber(field)) {
            EXPECT_LT(field.min, field.max) << field.name();
        }
    }
    EXPECT_GT(names.size(), 20U);
}

TEST(Options, OneOutOfRangeNamesItselfItsValueAndItsRange) {
    forEveryLimit([](const OdometryOptions& options, const OptionField& field, bool upper) {
        const double step = std::max(1.0, std::abs(limit(field, upper)));
        put(field, limit(field, upper) + (upper ? step : -step));
        const std::string fault = checkOptions(options);
        EXPECT_TRUE(contains(fault, field.name())) << fault;
        EXPECT_TRUE(contains(fault, field.toText())) << fault;
        EXPECT_TRUE(contains(fault, "outside")) << fault;
        EXPECT_EQ(fault.find('\n'), std::string::npos);
        OdometryOptions again;
        EXPECT_EQ(setOption(again, field.name(), field.toText()), fault);
    });
}

TEST(Options, LimitsThemselvesAreAllowed) {
    forEveryLimit([](const OdometryOptions&, const OptionField& field, bool upper) {
        put(field, limit(field, upper));
        EXPECT_EQ(field.check(), "") << field.name();
    });
}

TEST(Options, TextGoesThereAndBack) {
    OdometryOptions options;
    for (const auto& field : optionFields(options)) {
        if (auto* const* real = std::get_if<double*>(&field.value)) {
            **real = field.min + (field.max - field.min) / 3;
        } else if (auto* const* whole = std::get_if<int*>(&field.value)) {
            **whole = static_cast<int>(field.min + (field.max - field.min) / 3);
        } else if (auto* const* flag = std::get_if<bool*>(&field.value)) {
            **flag = !**flag;
        } else {
            *std::get<Mode*>(field.value) = Mode::kCoarse;
        }
    }
    OdometryOptions copy;
    auto from = optionFields(options);
    for (const auto& field : from)
        EXPECT_EQ(setOption(copy, field.name(), field.toText()), "") << field.name();
    auto to = optionFields(copy);
    for (std::size_t i = 0; i < from.size(); ++i) {
        EXPECT_EQ(from[i].toText(), to[i].toText()) << from[i].name();
        if (auto* const* real = std::get_if<double*>(&from[i].value)) {
            EXPECT_EQ(**real, **std::get_if<double*>(&to[i].value)) << from[i].name();
        }
    }
}

TEST(Options, NotFiniteIsRefused) {
    OdometryOptions reference;
    const std::size_t count = optionFields(reference).size();
    for (std::size_t i = 0; i < count; ++i) {
        for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity()}) {
            OdometryOptions options;
            const auto field = optionFields(options)[i];
            if (!std::holds_alternative<double*>(field.value)) continue;
            put(field, bad);
            EXPECT_TRUE(contains(checkOptions(options), field.name()));
        }
        for (const char* text : {"nan", "inf", "-inf", "1e999", "", " ", "abc", "1,5", "1.0x", "0x10"}) {
            OdometryOptions options;
            const auto field = optionFields(options)[i];
            const std::string fault = setOption(options, field.name(), text);
            EXPECT_TRUE(contains(fault, field.name())) << field.name() << " took '" << text << "': " << fault;
        }
    }
}

TEST(Options, ARefusedOneKeepsItsValue) {
    OdometryOptions reference;
    const std::size_t count = optionFields(reference).size();
    for (std::size_t i = 0; i < count; ++i) {
        OdometryOptions options;
        const auto field = optionFields(options)[i];
        const std::string before = field.toText();
        for (const char* text : {"-1e9", "1e12", "1e999", "nan", "2x", "", "slam"}) {
            EXPECT_NE(setOption(options, field.name(), text), "") << field.name() << " took '" << text << "'";
            EXPECT_EQ(field.toText(), before) << field.name() << " after '" << text << "'";
        }
    }
    OdometryOptions options;
    options.edges.min_length = 17;  // not the default
    EXPECT_NE(setOption(options, "edges.min_length", "-3"), "");
    EXPECT_EQ(options.edges.min_length, 17);
}

TEST(Options, WholeNumbersMustBeWhole) {
    OdometryOptions options;
    EXPECT_TRUE(contains(setOption(options, "edges.min_length", "10.5"), "whole"));
    EXPECT_TRUE(contains(setOption(options, "edges.min_length", "99999999999"), "edges.min_length"));
}

TEST(Options, UnknownKeyNamesTheClosest) {
    OdometryOptions options;
    for (const auto& [typed, meant] :
         {std::pair("edges.min_lenght", "edges.min_length"),
          std::pair("fine.serch_radius", "fine.search_radius"), std::pair("angle_deg", "edges.angle_deg"),
          std::pair("odometry.mod", "odometry.mode")}) {
        const std::string fault = setOption(options, typed, "1");
        EXPECT_TRUE(contains(fault, "unknown option")) << fault;
        EXPECT_TRUE(contains(fault, std::string("'") + typed + "'")) << fault;
        EXPECT_TRUE(contains(fault, std::string("'") + meant + "'")) << fault;
    }
    EXPECT_TRUE(contains(setOption(options, "", "1"), "unknown option"));
}

TEST(Options, ARightKeyInTheWrongSectionIsFound) {
    OdometryOptions options;
    for (const auto& [typed, meant] :
         {std::pair("fine.window", "mapping.window"), std::pair("camera.depth_limit", "sensor.depth_limit"),
          std::pair("Sensor.Max-Depth", "sensor.max_depth"),
          std::pair("mapping.estimate_readot", "sensor.estimate_readout")}) {
        const std::string fault = setOption(options, typed, "1");
        EXPECT_TRUE(contains(fault, std::string("closest is '") + meant + "'")) << fault;
    }
}

TEST(Options, ABeginningStandsForTheWhole) {
    OdometryOptions options;
    for (const auto& [typed, meant] : {std::pair("keyframe.max_rot", "keyframe.max_rotation_deg"),
                                       std::pair("keyframe.max_trans", "keyframe.max_translation"),
                                       std::pair("mapping.semi_dense", "mapping.semi_dense_points")}) {
        const std::string fault = setOption(options, typed, "1");
        EXPECT_TRUE(contains(fault, std::string("closest is '") + meant + "'")) << fault;
    }
}

TEST(Options, EquallyCloseKeysAreAllNamed) {
    OdometryOptions options;
    const std::string fault = setOption(options, "max_points", "1000");
    for (const char* meant : {"'coarse.max_points'", "'fine.max_points'", "'mapping.max_points'"})
        EXPECT_TRUE(contains(fault, meant)) << fault;
    EXPECT_FALSE(contains(setOption(options, "coarse.max_point", "1"), "fine.max_points"));
}

TEST(Options, ModesAreCtAndTr) {
    OdometryOptions options;
    EXPECT_EQ(setOption(options, "odometry.mode", "ct"), "");
    EXPECT_EQ(options.mode, Mode::kCoarse);
    EXPECT_EQ(setOption(options, "odometry.mode", " tr "), "");
    EXPECT_EQ(options.mode, Mode::kTracking);
    EXPECT_TRUE(contains(setOption(options, "odometry.mode", "slam"), "'slam'"));
    EXPECT_EQ(options.mode, Mode::kTracking);
}

TEST(Options, AModeThatIsNoneIsRefused) {
    OdometryOptions options;
    options.mode = static_cast<Mode>(7);
    EXPECT_EQ(checkOptions(options), "option odometry.mode = 7 is none of ct, tr, ba");
}

TEST(Options, DepthRangeMustBeARange) {
    OdometryOptions options;
    options.sensor.min_depth = 3;
    options.sensor.max_depth = 2;
    const std::string fault = checkOptions(options);
    EXPECT_TRUE(contains(fault, "sensor.max_depth") && contains(fault, "sensor.min_depth")) << fault;
}

TEST(Options, OdometryRefusesBadOnesWithTheirLine) {
    const PinholeCamera camera{320, 240, 260, 260, 159.5, 119.5, {}};
    OdometryOptions options;
    options.edges.angle_deg = 400;
    try {
        Odometry odometry(camera, options);
        FAIL() << "accepted";
    } catch (const std::invalid_argument& error) {
        EXPECT_EQ(error.what(), checkOptions(options));
    }
    EXPECT_THROW(Odometry(PinholeCamera(), OdometryOptions()), std::invalid_argument);
}

TEST(Options, ThoseThatMustFitEachOtherAreNamedTogether) {
    OdometryOptions radii;
    radii.fine.final_radius = 7;
    EXPECT_EQ(checkOptions(radii), "option fine.final_radius = 7 must not exceed fine.search_radius = 6");
    OdometryOptions depths;
    depths.sensor.depth_limit = depths.sensor.min_depth;
    EXPECT_NE(checkOptions(depths).find("sensor.depth_limit"), std::string::npos) << checkOptions(depths);
    EXPECT_EQ(checkOptions(OdometryOptions()), "");
}

TEST(ThreadCount, IsOfTheProcessorsThatTheProcessMayUse) {
    EXPECT_EQ(threadCount(3), 3);
    cpu_set_t before, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
    EXPECT_EQ(threadCount(0), CPU_COUNT(&before));
    CPU_ZERO(&one);
    CPU_SET(sched_getcpu(), &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    EXPECT_EQ(threadCount(0), 1);
    sched_setaffinity(0, sizeof before, &before);
}

}  // namespace
}  // namespace roevo
