// Faults are values while they are handled; what a user reads of each is one line that no other has.
#include <gtest/gtest.h>

#include <set>

#include "roevo/edge_map.h"
#include "tracking/fault.h"

namespace roevo {
namespace {

constexpr auto kLast = Fault::Kind::kTimeLeap;

/// How many numbers are part of the words. The compiler asks here for kinds that come to be.
std::size_t numbersOf(Fault::Kind kind) {
    using Kind = Fault::Kind;
    switch (kind) {
        case Kind::kGreySize:
        case Kind::kColourSize:
        case Kind::kDepthSize:
        case Kind::kMaskSize:
            return 4;
        case Kind::kDepthContradicts:
        case Kind::kGap:
        case Kind::kUnconfirmed:
        case Kind::kTimeLeap:
            return 1;
        case Kind::kFewPointsWithDepth:
        case Kind::kFewPointsInView:
        case Kind::kFewInliers:
        case Kind::kFewMatched:
            return 2;
        case Kind::kNone:
        case Kind::kTimeNotFinite:
        case Kind::kTimeUnit:
        case Kind::kTimeRepeated:
        case Kind::kTimeBackward:
        case Kind::kNoColour:
        case Kind::kGreyType:
        case Kind::kColourType:
        case Kind::kDepthType:
        case Kind::kMaskType:
        case Kind::kNoDepth:
        case Kind::kCoarseAstray:
        case Kind::kDiverged:
        case Kind::kFrozen:
            return 0;
    }
    return 0;
}

TEST(Fault, EveryKindHasWordsOfItsOwnOnOneLine) {
    const std::string unknown = describe(Fault{static_cast<Fault::Kind>(static_cast<int>(kLast) + 1), {}});
    std::set<std::string> words;
    for (int k = 1; k <= static_cast<int>(kLast); ++k) {
        const Fault fault{static_cast<Fault::Kind>(k), {641, 482, 323, 244}};
        const std::string text = describe(fault);
        EXPECT_TRUE(fault) << k;
        EXPECT_NE(text, "") << k;
        EXPECT_NE(text, unknown) << k << " has no words";
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        EXPECT_TRUE(words.insert(text).second) << "twice: " << text;
        for (std::size_t i = 0; i < fault.numbers.size(); ++i) {
            const bool said = text.find(std::to_string(fault.numbers[i])) != std::string::npos;
            EXPECT_EQ(said, i < numbersOf(fault.kind)) << text << ": number " << i;
        }
    }
}

TEST(Fault, NoneIsNoneAndSaysNothing) {
    EXPECT_FALSE(Fault());
    EXPECT_EQ(describe(Fault()), "");
}

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
