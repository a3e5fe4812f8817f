// Maps of roevo-odometry: --map-out, --map-in, --localise-only.
#include <filesystem>
#include <fstream>

#include "evaluation/trajectory_io.h"
#include "odometry_fixture.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::expectError;
using test::OdometryProgram;
using test::readFile;
using test::slidingRecording;

class MapProgram : public OdometryProgram {
  protected:
    std::string map() const { return folder_ / "wall.map"; }
    std::string recording() const { return folder_ / "recording"; }

    static void mirror(test::TumFrame& frame) {
        for (cv::Mat* image : {&frame.colour, &frame.depth})
            for (int row = 0; row < image->rows / 2; ++row)
                for (std::size_t k = 0; k < image->elemSize() * static_cast<std::size_t>(image->cols); ++k)
                    std::swap(image->ptr(row)[k], image->ptr(image->rows - 1 - row)[k]);
    }

    /// The same wall, played backwards from its middle, mirrored where it is to be another place.
    std::string otherRecording(bool another_place) const {
        std::vector<test::TumFrame> frames = slidingRecording(24), chosen;
        for (std::size_t i = 0; i < 12; ++i) {
            test::TumFrame frame = frames[frames.size() - 1 - i];
            frame.timestamp = 500 + frames[i].timestamp;
            if (another_place) mirror(frame);
            chosen.push_back(frame);
        }
        test::writeTumFolder(folder_ / "other", chosen);
        return folder_ / "other";
    }
};

TEST_F(MapProgram, AMapIsWrittenUsedAndExtended) {
    const auto made = runFrames(slidingRecording(24), {"--map-out", map()});
    ASSERT_EQ(made.exit_code, 0) << made.all();
    EXPECT_EQ(summary()["map_in"], nullptr);
    EXPECT_EQ(summary()["map_out"]["file"], map());
    const int keyframes = summary()["map_out"]["keyframes"];
    EXPECT_EQ(keyframes, summary()["frames"]["keyframes"]);
    const std::string before = readFile(map());
    const int edges_before = summary()["map"]["edges"];

    for (const bool localise_only : {true, false}) {
        std::vector<std::string> more{"--map-in", map()};
        if (localise_only) more.push_back("--localise-only");
        if (!localise_only) more.insert(more.end(), {"--map-out", map()});
        const auto used = run(otherRecording(false), more);
        ASSERT_EQ(used.exit_code, 0) << used.all();
        EXPECT_EQ(used.err.find("warning"), std::string::npos) << used.err;
        EXPECT_NE(used.out.find("map in      " + map() + ", " + std::to_string(keyframes) +
                                (keyframes == 1 ? " keyframe" : " keyframes") + ": recognised at keyframe "),
                  std::string::npos)
            << used.out;
        const auto json = summary();
        EXPECT_EQ(json["map_in"]["keyframes"], keyframes);
        EXPECT_EQ(json["map_in"]["localise_only"], localise_only);
        EXPECT_EQ(json["map_in"]["localised"]["frame"], 0);
        EXPECT_LT(json["map_in"]["localised"]["keyframe"].get<int>(), keyframes);
        EXPECT_EQ(json["losses"]["pieces"], 1);
        EXPECT_GE(json["map"]["edges"].get<int>(), edges_before);
        // In the map's world, in which the camera was at x = 0.23 m in the 24th frame
        const auto poses = readTumTrajectory(output() + "/trajectory.txt");
        ASSERT_EQ(poses.size(), 12U);
        for (std::size_t i = 0; i < poses.size(); ++i)
            EXPECT_LT((poses[i].T_world_camera.translation() -
                       Eigen::Vector3d(0.23 - 0.01 * static_cast<double>(i), 0, 0))
                          .norm(),
                      0.01)
                << i;
        const auto own = readTumTrajectory(output() + "/keyframes.txt");
        EXPECT_EQ(own.size(), json["frames"]["keyframes"].get<std::size_t>());
        for (const StampedPose& pose : own) EXPECT_GT(pose.timestamp, 500) << "of this recording";
        if (localise_only) {
            EXPECT_TRUE(readFile(map()) == before);
            continue;
        }
        EXPECT_EQ(
            json["map_out"]["keyframes"].get<std::size_t>() + json["map_out"]["covered"].get<std::size_t>(),
            static_cast<std::size_t>(keyframes) + own.size());
        EXPECT_FALSE(readFile(map()) == before) << "replaced";
    }
}

TEST_F(MapProgram, WhereItIsNotRecognisedThatIsSaid) {
    ASSERT_EQ(runFrames(slidingRecording(24), {"--map-out", map()}).exit_code, 0);
    const auto result =
        run(otherRecording(true), {"--map-in", map(), "--map-out", folder_ / "more.map", "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.err.find("never recognised in the map: the trajectory is in a world of its own"),
              std::string::npos)
        << result.all();
    EXPECT_EQ(summary()["map_in"]["localised"], nullptr);
    EXPECT_EQ(summary()["map_in"]["segment"], nullptr);
    EXPECT_TRUE(readFile(folder_ / "more.map") == readFile(map())) << "nothing was added";
}

/// A wall, and then another one, as after a gap in the recording.
TEST_F(MapProgram, WhatIsNotJoinedIsSaidToBeInNoMapAndNotInItsWorld) {
    ASSERT_EQ(runFrames(slidingRecording(24), {"--map-out", map()}).exit_code, 0);
    std::vector<test::TumFrame> frames = slidingRecording(24);
    for (std::size_t i = 0; i < 16; ++i) mirror(frames[i]);
    const std::vector<std::string> soon{"--set", "loss.max_predicted=0", "--map-out", folder_ / "two.map"};
    auto result = runFrames(frames, soon);
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_EQ(summary()["losses"]["pieces"], 2) << "else it is no test";
    const int left_out = summary()["map_out"]["left_out"];
    EXPECT_GT(left_out, 0);
    EXPECT_EQ(summary()["map_out"]["keyframes"].get<int>() + left_out, summary()["frames"]["keyframes"]);
    EXPECT_NE(result.out.find(" of pieces that were not joined to these left out"), std::string::npos)
        << result.out;
    EXPECT_NEAR(summary()["path_length_m"].get<double>(), 0.22, 0.01) << "15 and 7 steps of 1 cm";

    std::vector<std::string> with_map = soon;
    with_map.insert(with_map.end(), {"--map-in", map(), "--covariances", folder_ / "covariances.txt"});
    result = run(recording(), with_map);
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_EQ(reason(16).find("found in the map at keyframe "), 0U) << reason(16);
    EXPECT_NE(result.out.find("lost once, found in the map"), std::string::npos) << result.out;
    EXPECT_EQ(summary()["map_in"]["localised"]["frame"], 16);
    EXPECT_EQ(summary()["map_in"]["segment"], 2);
    EXPECT_NE(result.err.find("wall.map: only segment 2 of 2 (see frames.csv) is in the map's world"),
              std::string::npos)
        << result.err;
    EXPECT_NE(readFile(folder_ / "covariances.txt").find("# relative to the first keyframe of the map from "),
              std::string::npos);
}

TEST_F(MapProgram, WhatIsNoMapIsRefusedInOneLine) {
    ASSERT_EQ(runFrames(slidingRecording(12), {"--map-out", map()}).exit_code, 0);
    const auto expect = [&](const std::string& file, const std::vector<std::string>& words) {
        expectError(run(recording(), {"--map-in", file}), 1, kName, words);
    };
    expect(folder_ / "none.map", {"none.map", "cannot read"});
    expect(recording(), {"it is a folder"});
    expect(recording() + "/camera.txt", {"camera.txt", "no map"});
    fs::resize_file(map(), fs::file_size(map()) / 2);
    expect(map(), {"wall.map", "incomplete"});

    ASSERT_EQ(run(recording(), {"--map-out", map()}).exit_code, 0);
    std::ofstream(recording() + "/camera.txt")
        << "width: 320\nheight: 240\nfx: 301\nfy: 301\ncx: 160\ncy: 120\ndepth_scale: 5000\n";
    expect(map(), {"wall.map", "another camera", "fx 300", "fx 301"});
}

TEST_F(MapProgram, AMapIsWrittenWholeOrNotAtAll) {
    test::writeTumFolder(recording(), slidingRecording(3));
    expectError(run(recording(), {"--map-out", folder_ / "no/such/wall.map"}), 1, kName,
                {"no/such/wall.map", "cannot write"});
    expectError(run(recording(), {"--map-out", folder_.path().string()}), 1, kName, {"it is a folder"});
    EXPECT_FALSE(fs::exists(map()));
    // Nothing that is read, or written besides, is written over
    fs::remove_all(output());
    expectError(run(recording(), {"--map-out", recording()}), 2, kName, {"--map-out", "an input"});
    expectError(run(recording(), {"--map-out", output() + "/trajectory.txt"}), 2, kName,
                {"--map-out", "trajectory.txt", "the run writes itself"});
    expectError(run(recording(), {"--map-out", map(), "--covariances", map()}), 2, kName,
                {"--covariances", "is what --map-out names"});
    test::writeFile(folder_ / "own.ini", "[edges]\nmin_length = 8\n");
    for (const char* option : {"--map-out", "--covariances", "--simplemap"})
        expectError(run(recording(), {"--config", folder_ / "own.ini", option, folder_ / "own.ini"}), 2,
                    kName, {option, "own.ini is an input"});
    std::string pairs;
    std::istringstream colours(readFile(recording() + "/rgb.txt")),
        depths(readFile(recording() + "/depth.txt"));
    for (std::string colour, depth; std::getline(colours, colour) && std::getline(depths, depth);)
        pairs += colour + " " + depth + "\n";
    test::writeFile(folder_ / "pairs.txt", pairs);
    const std::vector<std::string> on_top{"--associations", folder_ / "pairs.txt", "--map-out",
                                          folder_ / "pairs.txt"};
    expectError(run(recording(), on_top), 2, kName, {"--map-out", "pairs.txt is an input"});
    EXPECT_FALSE(fs::exists(output())) << "refused before anything is begun";
    // A run that fails leaves what was there
    std::ofstream(map()) << "what was there";
    std::vector<test::TumFrame> blank = slidingRecording(3);
    for (auto& frame : blank) frame.depth = cv::Mat(frame.depth.size(), frame.depth.type(), cv::Scalar(0));
    EXPECT_EQ(runFrames(blank, {"--map-out", map()}).exit_code, 1);
    EXPECT_EQ(readFile(map()), "what was there");
    for (const auto& entry : fs::directory_iterator(fs::path(map()).parent_path()))
        EXPECT_EQ(entry.path().filename().string().find("partial"), std::string::npos) << entry.path();
}

TEST_F(MapProgram, ToLocaliseTakesAMap) {
    test::writeTumFolder(recording(), slidingRecording(2));
    expectError(run(recording(), {"--localise-only"}), 2, kName, {"--localise-only", "--map-in"});
    expectError(run(recording(), {"--localise-only", "--map-in", map(), "--map-out", map()}), 2, kName,
                {"--localise-only", "--map-out"});
    for (const std::string option : {"--map-in", "--map-out"})
        expectError(run(recording(), {option, map(), "--set", "loss.recognise=false"}), 2, kName,
                    {"loss.recognise"});
}

}  // namespace
}  // namespace roevo
