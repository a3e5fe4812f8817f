// Maps that are kept: written and read again, used by other recordings, and files that are not what they
// should be.
#include <gtest/gtest.h>

#include <cstring>
#include <optional>
#include <random>
#include <sstream>

#include "core/support/simulated.h"
#include "odometry/map_file.h"

namespace roevo {
namespace {

using testing::Sequence;
using testing::simulate;

simulator::SimulationOptions noisyRoom(unsigned seed, double speed) {
    simulator::SimulationOptions options = testing::smallRoom();
    options.useKinectNoise();
    options.seed = seed;
    options.speed = speed;
    return options;
}

/// What is mapped, and the same room on another day: other tremor, faster, further.
const Sequence& yesterday() {
    static const Sequence sequence = simulate(noisyRoom(1, 0.45), 24);
    return sequence;
}
const Sequence& today() {
    static const Sequence sequence = simulate(noisyRoom(7, 0.8), 40);
    return sequence;
}
/// Backwards, from further than yesterday's map goes.
const Sequence& wayBack() {
    static const Sequence sequence = [] {
        const simulator::Simulator simulator(noisyRoom(7, 0.8));
        Sequence back;
        back.camera = simulator.camera();
        for (int i = 99; i >= 80; --i) {
            const simulator::SimulatedFrame frame = simulator.frame(i);
            const double timestamp = 10 - frame.timestamp;
            back.frames.push_back({timestamp, frame.grey, frame.depth_noisy, cv::Mat()});
            back.truth.push_back({timestamp, frame.T_world_camera});
        }
        return back;
    }();
    return sequence;
}
const Sequence& elsewhere() {
    static const Sequence sequence = [] {
        simulator::SimulationOptions options = noisyRoom(3, 0.45);
        options.scene = "corridor";
        return simulate(options, 20);
    }();
    return sequence;
}

OdometryOptions optionsOf(Mode mode) {
    OdometryOptions options;
    options.mode = mode;
    options.keyframe.max_translation = 0.025;  // more of them in less time
    return options;
}

std::string mapOf(const Odometry& odometry) {
    std::ostringstream out;
    odometry.saveMap(out);
    return out.str();
}

/// Yesterday's map, in a world that is the truth's.
const std::string& yesterdaysMap(Mode mode) {
    static const std::string maps[] = {
        [] {
            Odometry odometry(yesterday().camera, optionsOf(Mode::kTracking), yesterday().start());
            for (const RgbdFrame& frame : yesterday().frames) (void)odometry.processFrame(frame);
            return mapOf(odometry);
        }(),
        [] {
            Odometry odometry(yesterday().camera, optionsOf(Mode::kBundleAdjustment), yesterday().start());
            for (const RgbdFrame& frame : yesterday().frames) (void)odometry.processFrame(frame);
            return mapOf(odometry);
        }()};
    return maps[mode == Mode::kBundleAdjustment ? 1 : 0];
}

int load(Odometry& odometry, const std::string& map, MapUse use = MapUse::kExtend) {
    std::istringstream in(map);
    return odometry.loadMap(in, use);
}

std::string faultOfLoading(Odometry& odometry, const std::string& map) {
    try {
        load(odometry, map);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

double worstError(const std::vector<StampedPose>& poses, const Sequence& sequence, std::size_t first = 0) {
    double worst = 0;
    for (std::size_t i = first; i < poses.size(); ++i)
        worst = std::max(
            worst,
            (poses[i].T_world_camera.translation() - sequence.truth[i].T_world_camera.translation()).norm());
    return worst;
}

class MapFile : public ::testing::TestWithParam<Mode> {
  protected:
    Odometry odometryOf(const Sequence& sequence) const { return {sequence.camera, optionsOf(GetParam())}; }
    const std::string& map() const { return yesterdaysMap(GetParam()); }
};

TEST_P(MapFile, WrittenReadAndWrittenAgainIsTheSame) {
    for (const Mode mode : {Mode::kTracking, Mode::kBundleAdjustment}) {
        Odometry odometry = odometryOf(yesterday());
        const int keyframes = load(odometry, yesterdaysMap(mode));
        EXPECT_GE(keyframes, 3);
        EXPECT_TRUE(odometry.keyframes().empty()) << "they are in no world of this recording yet";
        EXPECT_FALSE(odometry.isLocalised());
        std::ostringstream out;
        EXPECT_EQ(odometry.saveMap(out), keyframes);
        EXPECT_TRUE(out.str() == yesterdaysMap(mode));
    }
}

TEST_P(MapFile, AnotherRecordingIsLocalisedFromItsFirstFrameOn) {
    Odometry odometry = odometryOf(today());
    const int keyframes = load(odometry, map());
    const FrameResult first = odometry.processFrame(today().frames[0]);
    EXPECT_EQ(first.status, FrameStatus::kInitialised) << first.reason;
    EXPECT_GE(first.found_at, 0) << first.reason;
    EXPECT_LT(first.found_at, keyframes);
    for (std::size_t i = 1; i < today().frames.size(); ++i)
        EXPECT_EQ(odometry.processFrame(today().frames[i]).status, FrameStatus::kOk);
    EXPECT_LT(worstError(odometry.trajectory(), today()), 0.01);
    EXPECT_EQ(odometry.trajectory().size(), today().frames.size()) << "frames of this recording only";
    EXPECT_GT(static_cast<int>(odometry.keyframes().size()), keyframes);
    EXPECT_TRUE(odometry.isLocalised());
}

TEST_P(MapFile, ARecordingThatBeginsElsewhereIsJoined) {
    Odometry odometry = odometryOf(wayBack());
    const int keyframes = load(odometry, map());
    int joined_at = -1;
    for (const RgbdFrame& frame : wayBack().frames) {
        const FrameResult result = odometry.processFrame(frame);
        EXPECT_TRUE(result.hasPose()) << result.reason;
        EXPECT_EQ(result.found_at, -1);
        const bool is_first = result.joined_at >= 0 && joined_at < 0;
        if (is_first) joined_at = result.joined_at;
        const std::string found = "found in the map at keyframe " + std::to_string(joined_at);
        EXPECT_EQ(result.reason.find(found) != std::string::npos, is_first) << result.reason;
    }
    EXPECT_GE(joined_at, 0);
    EXPECT_LT(joined_at, keyframes);
    EXPECT_LT(worstError(odometry.trajectory(), wayBack()), 0.02) << "also before it was recognised";
}

TEST_P(MapFile, ACameraThatIsFirstFoundInTheMapAfterALossIsSaidToBe) {
    Odometry odometry = odometryOf(today());
    load(odometry, map());
    const auto &room = today().frames, &corridor = elsewhere().frames;
    std::vector<RgbdFrame> frames{corridor[0], corridor[1], corridor[2], room[0], corridor[2], room[8]};
    std::vector<std::string> reasons;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        frames[i].timestamp = static_cast<double>(i) / 3;
        reasons.push_back(odometry.processFrame(frames[i]).reason);
    }
    EXPECT_EQ(reasons[3].find("found in the map at keyframe "), 0U) << reasons[3];
    EXPECT_EQ(reasons[5].find("found again at keyframe "), 0U) << reasons[5];
}

/// What a camera at rest shows is no keyframe; it is looked at all the same.
TEST_P(MapFile, ACameraThatComesToRestBeforeAKnownPlaceIsLocalised) {
    OdometryOptions options = optionsOf(GetParam());
    options.keyframe.max_translation = 1;
    Odometry odometry(today().camera, options);
    load(odometry, yesterdaysMap(GetParam()), MapUse::kLocalise);
    const RgbdFrame& view = today().frames[8];
    cv::Mat hidden(view.grey.size(), CV_8UC1, cv::Scalar(255));
    hidden.colRange(0, 4 * view.grey.cols / 5).setTo(0);  // too little is left to tell the place
    std::optional<int> found;
    for (int i = 0; i < 20 && !found; ++i) {
        RgbdFrame frame = view;
        frame.timestamp += i / 30.;
        if (i < 3) frame.mask = hidden;
        const FrameResult result = odometry.processFrame(frame);
        ASSERT_TRUE(result.hasPose()) << result.reason;
        if (i == 0) {
            ASSERT_EQ(result.found_at, -1) << "else it is no test";
        }
        if (result.joined_at >= 0) found = i;
    }
    ASSERT_TRUE(found);
    EXPECT_LE(*found, 12);
    const Pose& pose = odometry.trajectory().back().T_world_camera;
    EXPECT_LT((pose.translation() - today().truth[8].T_world_camera.translation()).norm(), 0.02);
}

TEST_P(MapFile, AnotherRoomIsNeverRecognised) {
    Odometry odometry = odometryOf(elsewhere());
    const int keyframes = load(odometry, map());
    for (const RgbdFrame& frame : elsewhere().frames) {
        const FrameResult result = odometry.processFrame(frame);
        EXPECT_EQ(result.found_at, -1);
        EXPECT_EQ(result.joined_at, -1);
    }
    EXPECT_EQ(odometry.trajectory().front().T_world_camera.matrix(), Pose().matrix()) << "its own world";
    EXPECT_FALSE(odometry.isLocalised());
    for (const KeyframeInfo& keyframe : odometry.keyframes()) EXPECT_GE(keyframe.id, keyframes);
    for (const MapEdge& edge : odometry.map())
        EXPECT_GE(edge.keyframe_id, keyframes) << "the map's is not shown";
    EXPECT_TRUE(mapOf(odometry) == map()) << "and nothing is added to it";
}

TEST_P(MapFile, ToLocaliseLeavesTheMapAsItIs) {
    Odometry odometry = odometryOf(today());
    const auto keyframes = static_cast<std::size_t>(load(odometry, map(), MapUse::kLocalise));
    const std::vector<KeyframeInfo> before = odometry.keyframes();
    for (const RgbdFrame& frame : today().frames) (void)odometry.processFrame(frame);
    EXPECT_LT(worstError(odometry.trajectory(), today()), 0.01);
    const std::vector<KeyframeInfo> after = odometry.keyframes();
    for (std::size_t k = 0; k < keyframes; ++k)
        EXPECT_EQ(before[k].T_world_camera.matrix(), after[k].T_world_camera.matrix()) << k;
    EXPECT_THROW(mapOf(odometry), std::logic_error);
}

TEST_P(MapFile, WhatWasAddedIsFoundLater) {
    Odometry odometry = odometryOf(today());
    const int keyframes = load(odometry, map());
    for (const RgbdFrame& frame : today().frames) (void)odometry.processFrame(frame);
    std::vector<int> edges_of(odometry.keyframes().size());
    for (const MapEdge& edge : odometry.keyframeEdges())
        ++edges_of[static_cast<std::size_t>(edge.keyframe_id)];
    EXPECT_EQ(std::count(edges_of.begin(), edges_of.end(), 0), 0) << "edges of both";
    const std::string extended = mapOf(odometry);

    Odometry later = odometryOf(today());
    const int loaded = load(later, extended);
    EXPECT_GT(loaded, keyframes);
    EXPECT_LE(loaded, static_cast<int>(odometry.keyframes().size())) << "without what shows nothing new";
    EXPECT_TRUE(mapOf(later) == extended);
    const FrameResult result = later.processFrame(today().frames.back());
    EXPECT_GE(result.found_at, keyframes) << result.reason;
    EXPECT_LT(
        (result.T_world_camera.translation() - today().truth.back().T_world_camera.translation()).norm(),
        0.02);
}

INSTANTIATE_TEST_SUITE_P(Modes, MapFile, ::testing::Values(Mode::kTracking, Mode::kBundleAdjustment));

TEST(MapFileErrors, AreSaidInOneLine) {
    const std::string& map = yesterdaysMap(Mode::kBundleAdjustment);
    Odometry odometry(yesterday().camera, {});
    const auto expect = [&](const std::string& bytes, const std::string& words) {
        const std::string fault = faultOfLoading(odometry, bytes);
        EXPECT_NE(fault.find(words), std::string::npos) << fault;
        EXPECT_EQ(fault.find('\n'), std::string::npos);
    };
    expect("", "no map");
    expect("1311868164.36 0 0 0 0 0 0 1\n1311868164.39 0 0 0 0 0 0 1\n", "no map");
    std::string other = map;
    other[8] = 9;
    expect(other, "version 9");
    expect(map.substr(0, map.size() / 2), "incomplete");
    expect(map + "x", "more after its end");
    other = map;
    other[map.size() / 2] = static_cast<char>(other[map.size() / 2] ^ 1);
    expect(other, "checksum");
    other = map;
    std::memset(&other[12], 0x7F, 8);  // claims more than there is memory
    expect(other, "incomplete");
    EXPECT_GE(load(odometry, map), 3) << "none of that is left over";

    PinholeCamera camera = yesterday().camera;
    camera.fx += 1;
    Odometry another(camera, {});
    const std::string fault = faultOfLoading(another, map);
    EXPECT_NE(fault.find("another camera"), std::string::npos) << fault;
    OdometryOptions blind;
    blind.loss.recognise = false;
    Odometry unable(yesterday().camera, blind);
    EXPECT_NE(faultOfLoading(unable, map).find("loss.recognise"), std::string::npos);
}

TEST(MapFileLens, KeepsALensOfMoreTerms) {
    const std::vector<std::pair<std::array<double, 3>, LensModel>> lenses = {
        {{0.01, 0.02, 0.03}, LensModel::kBrownConrady}, {{}, LensModel::kKannalaBrandt}};
    for (const auto& [denominator, lens] : lenses) {
        PinholeCamera camera = yesterday().camera;
        camera.denominator = denominator;
        camera.lens = lens;
        Odometry odometry(camera, {});
        for (const RgbdFrame& frame : yesterday().frames) (void)odometry.processFrame(frame);
        const std::string map = mapOf(odometry);
        Odometry same(camera, {}), plain(yesterday().camera, {});
        EXPECT_EQ(load(same, map), static_cast<int>(odometry.keyframes().size()));
        EXPECT_TRUE(mapOf(same) == map);
        const std::string fault = faultOfLoading(plain, map);
        EXPECT_NE(fault.find("another camera"), std::string::npos) << fault;
    }
}

TEST(MapFileErrors, AMapComesBeforeAllElse) {
    Odometry odometry(yesterday().camera, {});
    EXPECT_THROW(mapOf(odometry), std::runtime_error) << "there is none yet";
    load(odometry, yesterdaysMap(Mode::kTracking));
    EXPECT_THROW(load(odometry, yesterdaysMap(Mode::kTracking)), std::logic_error);
    Odometry begun(yesterday().camera, {});
    (void)begun.processFrame(yesterday().frames[0]);
    EXPECT_THROW(load(begun, yesterdaysMap(Mode::kTracking)), std::logic_error);
}

/// The same with a checksum that fits.
std::string signedAnew(std::string map) {
    std::uint64_t sum = 0xCBF29CE484222325U;
    for (std::size_t i = 28; i < map.size(); ++i)
        sum = (sum ^ static_cast<unsigned char>(map[i])) * 0x100000001B3U;
    for (std::size_t i = 0; i < 8; ++i) map[20 + i] = static_cast<char>(sum >> (8 * i) & 0xFF);
    return map;
}

/// A few keyframes are enough to break.
const std::string& smallMap() {
    static const std::string map = [] {
        OdometryOptions options = optionsOf(Mode::kBundleAdjustment);
        options.mapping.semi_dense_points = 50;
        options.mapping.max_points = 300;
        Odometry odometry(yesterday().camera, options);
        for (std::size_t i = 0; i < 20; ++i) (void)odometry.processFrame(yesterday().frames[i]);
        return mapOf(odometry);
    }();
    return map;
}

bool canBeRead(const std::string& map) {
    std::istringstream in(map);
    try {
        (void)readMap(in);
    } catch (const std::runtime_error&) {
        return false;
    }
    return true;
}

TEST(MapFileErrors, WhatIsDamagedIsRefused) {
    std::mt19937 random(5);
    ASSERT_TRUE(canBeRead(smallMap()));
    for (int k = 0; k < 150; ++k) {
        const std::size_t at = random() % smallMap().size();
        EXPECT_FALSE(canBeRead(smallMap().substr(0, at))) << at;
        std::string flipped = smallMap();
        flipped[at] = static_cast<char>(flipped[at] ^ (1 << random() % 8));
        EXPECT_FALSE(canBeRead(flipped)) << at;
    }
}

TEST(MapFileErrors, WhatIsWrongAndSignedIsRefusedOrDoesNoHarm) {
    std::mt19937 random(6);
    ASSERT_TRUE(signedAnew(smallMap()) == smallMap());
    int refused = 0, loaded = 0;
    for (int k = 0; k < 200; ++k) {
        std::string changed = smallMap();
        // The first part has the poses: there it matters most
        const std::size_t at = 28 + random() % (k % 2 == 0 ? 2000 : changed.size() - 28);
        const auto change = random() % 4;
        if (change == 0) changed[at] = static_cast<char>(random());
        if (change == 1) changed[at] = static_cast<char>(changed[at] ^ (1 << random() % 8));
        if (change == 2) std::memset(&changed[at], 0xFF, std::min<std::size_t>(8, changed.size() - at));
        if (change == 3) changed.erase(at, 1 + random() % 16);
        const std::uint64_t size = changed.size() - 28;
        std::memcpy(&changed[12], &size, sizeof size);
        if (!canBeRead(signedAnew(changed))) {
            ++refused;
            continue;
        }
        if (++loaded % 10 != 0) continue;
        Odometry odometry(yesterday().camera, {});
        if (const auto fault = faultOfLoading(odometry, signedAnew(changed)); !fault.empty()) {
            EXPECT_NE(fault.find("another camera"), std::string::npos) << k << ": " << fault;
            continue;
        }
        const FrameResult result = odometry.processFrame(today().frames[0]);
        EXPECT_TRUE(result.T_world_camera.isFinite() && result.covariance.allFinite()) << k;
        (void)odometry.map();
    }
    EXPECT_GT(refused, 20);
    EXPECT_GT(loaded, 20) << "else nothing was tried";
}

}  // namespace
}  // namespace roevo
