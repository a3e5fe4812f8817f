// What a user reads where the map left a keyframe as it was.
#include <gtest/gtest.h>

#include <set>

#include "roevo/edge_map.h"

namespace roevo {
namespace {

TEST(MapRefusal, EveryKindHasWordsOfItsOwnOnOneLine) {
    std::set<std::string> words;
    for (const auto kind : {MapRefusal::Kind::kFewObservations, MapRefusal::Kind::kMovedTooFar}) {
        const std::string text = describe(MapRefusal{kind, 17, 23, 0.041, 5.3});
        EXPECT_EQ(text.find(toString(kind)), 0U) << text;
        EXPECT_NE(text.find("keyframe 17"), std::string::npos) << text;
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        EXPECT_TRUE(words.insert(toString(kind)).second) << "twice: " << text;
    }
    const std::string few = describe(MapRefusal{MapRefusal::Kind::kFewObservations, 17, 23, 0.041, 5.3});
    EXPECT_NE(few.find("(23)"), std::string::npos) << few;
    const std::string far = describe(MapRefusal{MapRefusal::Kind::kMovedTooFar, 17, 23, 0.041, 5.3});
    EXPECT_NE(far.find("(41 mm, 5.3 deg)"), std::string::npos) << far;
}

}  // namespace
}  // namespace roevo
