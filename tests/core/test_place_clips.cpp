// Places of real clips: found again among those of all others, and never taken for another one. Skips,
// visibly, without the data.
#include <gtest/gtest.h>

#include "core/support/place_views.h"
#include "core/support/real_clip.h"
#include "place/place_evidence.h"
#include "place/place_index.h"

namespace roevo {
namespace {

using namespace testing;

struct PlaceClip {
    PinholeCamera camera;
    std::vector<std::unique_ptr<PlaceView>> views;
};

/// Every so many frames of a clip, with keyframe ids from `first_id` on.
PlaceClip placesOf(const std::string& name, std::size_t step, int first_id) {
    PlaceClip out;
    const DatasetReader reader = openDataset(test::dataFolder() + "/" + name);
    const std::vector<StampedPose> truth = readTumTrajectory(reader.groundTruthPath());
    out.camera = reader.camera();
    for (std::size_t i = 0; i < reader.size(); i += step) {
        const RgbdFrame frame = reader.readFrame(i);
        // Ground truth comes every 10 ms
        const auto nearest =
            std::min_element(truth.begin(), truth.end(), [&](const StampedPose& a, const StampedPose& b) {
                return std::abs(a.timestamp - frame.timestamp) < std::abs(b.timestamp - frame.timestamp);
            });
        const int id = first_id + static_cast<int>(out.views.size());
        out.views.push_back(makePlaceView(out.camera, frame, nearest->T_world_camera, id));
    }
    return out;
}

class PlaceClips : public ::testing::Test {
  protected:
    static constexpr const char* kNames[] = {"tum_fr3_cabinet_loop_58", "tum_fr1_xyz_150",
                                             "tum_fr3_structure_notexture_far_80", "icl_office_kt0_50"};
    static void SetUpTestSuite() {
        int id = 0;
        for (const char* name : kNames) {
            if (!std::filesystem::exists(test::dataFolder() + "/" + name)) return;
            clips_.push_back(placesOf(name, clips_.empty() ? 1 : 10, id));
            for (const auto& view : clips_.back().views) index_.insert(id++, view->points);
        }
    }
    static void TearDownTestSuite() {
        clips_.clear();
        index_ = PlaceIndex();
    }
    void SetUp() override {
        if (clips_.size() < std::size(kNames))
            GTEST_SKIP() << test::dataFolder() << " has not all clips; set ROEVO_DATA_DIR to their folder";
    }
    struct Found {
        int id = -1;  ///< -1: none is sure
        double likeness = 0;
        Pose T_frame_keyframe;
    };
    const PlaceView& viewOf(int id) const {
        for (const PlaceClip& clip : clips_)
            if (id <= clip.views.back()->keyframe.id)
                return *clip.views[static_cast<std::size_t>(id - clip.views.front()->keyframe.id)];
        return *clips_.back().views.back();
    }
    /// The one of the five candidates that it looks most like, where that needs no knowledge of where the
    /// camera is.
    Found recognise(const PlaceClip& clip, const PlaceView& view, const std::vector<int>& excluded) {
        const auto wanted = [&](int id) {
            return std::find(excluded.begin(), excluded.end(), id) == excluded.end();
        };
        EdgeRegistrar registrar(clip.camera, OdometryOptions(), false);
        PlaceDescriber describer(clip.camera);
        Found best;
        for (const PlaceCandidate& candidate : index_.query(view.points, 5, wanted)) {
            const PlaceView& other = viewOf(candidate.id);
            const auto points =
                verifyPlaces(view.points, view.keyframe.id, other.points, candidate.id, SensorOptions());
            if (!points) continue;
            const EdgeRegistration edges = registrar.registerEdges(
                other.keyframe, view.frame, view.keyframe.edges, points->T_candidate_query.inverse());
            const Likeness likeness = describer.compare(other.points, edges.T_frame_keyframe,
                                                        view.frame.pyramid.level(0), view.frame.images);
            if (evidenceOf(*points, edges, likeness) < Evidence::kStrong) continue;
            if (likeness.share() <= best.likeness) continue;
            best = {candidate.id, likeness.share(), edges.T_frame_keyframe};
        }
        return best;
    }

    inline static std::vector<PlaceClip> clips_;
    inline static PlaceIndex index_;
};

TEST_F(PlaceClips, KeyframesAroundTheCabinetAreFoundByTheirNeighbours) {
    const PlaceClip& clip = clips_.front();
    int sure = 0;
    double worst = 0;
    for (const auto& view : clip.views) {
        const Found found = recognise(clip, *view, {view->keyframe.id});
        if (found.id < 0) continue;
        ++sure;
        ASSERT_LT(found.id, static_cast<int>(clip.views.size())) << "another room";
        const Pose truth = view->T_world_camera.inverse() * viewOf(found.id).T_world_camera;
        worst = std::max(worst, poseError(found.T_frame_keyframe, truth));
    }
    RecordProperty("sure", sure);
    RecordProperty("worst_cm", std::to_string(100 * worst));
    EXPECT_GE(sure, 45) << "of " << clip.views.size();
    EXPECT_LT(worst, 0.12) << "the cabinet looks much the same from its other side";
}

TEST_F(PlaceClips, OtherRoomsAreNeverTakenForThisOne) {
    for (const PlaceClip& clip : clips_) {
        std::vector<int> own;
        for (const auto& view : clip.views) own.push_back(view->keyframe.id);
        for (const auto& view : clip.views)
            EXPECT_LT(recognise(clip, *view, own).id, 0) << "frame " << view->keyframe.id;
    }
}

// The cameras of two recordings, minutes apart, over one desk; both are known in the frame of motion capture.
TEST_F(PlaceClips, ADeskIsFoundAgainInAnotherRecording) {
    const std::string other = "tum_fr1_rpy_100";
    if (!std::filesystem::exists(test::dataFolder() + "/" + other)) GTEST_SKIP() << other << " is not there";
    const PlaceClip& first = clips_[1];
    const PlaceClip second = placesOf(other, 4, 1000);
    std::vector<int> elsewhere;
    for (const PlaceClip& clip : clips_)
        for (const auto& view : clip.views)
            if (&clip != &first) elsewhere.push_back(view->keyframe.id);
    int found = 0;
    std::vector<double> errors;
    for (const auto& view : second.views) {
        const Found place = recognise(second, *view, elsewhere);
        if (place.id < 0) continue;
        ++found;
        const Pose truth = view->T_world_camera.inverse() * viewOf(place.id).T_world_camera;
        errors.push_back(poseError(place.T_frame_keyframe, truth));
    }
    RecordProperty("found", found);
    ASSERT_GE(found, 18) << "of " << second.views.size();
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 0.09);
}

}  // namespace
}  // namespace roevo
