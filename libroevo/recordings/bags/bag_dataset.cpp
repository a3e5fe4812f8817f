#include "recordings/bags/bag_dataset.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <stdexcept>

#include "evaluation/association.h"
#include "input/excerpt.h"
#include "recordings/bags/bag_camera.h"
#include "recordings/bags/frame_tree.h"
#include "recordings/bags/image_messages.h"
#include "recordings/bags/realsense.h"
#include "recordings/depth_scale.h"
#include "recordings/image_lists.h"
#include "recordings/sensor_files.h"

namespace roevo {
namespace {

constexpr std::size_t kMostReasons = 10;

/// A message of a topic, by its header's stamp.
struct Stamped {
    double timestamp = 0;
    std::size_t message = 0;
};

std::string nameOf(const BagFile& bag, const std::string& topic, std::size_t message) {
    return bag.path() + ": " + excerpt(topic) + ", message " + std::to_string(message + 1);
}

/// Decodes the images of a bag.
class BagImages : public ImageStore {
  public:
    BagImages(std::shared_ptr<const BagFile> bag, const BagTopicNames& topics)
        : bag_(std::move(bag)), colour_(*bag_->find(topics.colour)), depth_(*bag_->find(topics.depth)) {}

    void add(std::size_t colour_message, std::size_t depth_message) {
        pairs_.emplace_back(colour_message, depth_message);
        too_far_.push_back(0);
    }

    /// That all depth images must have: of the first that can be read. @throws std::runtime_error
    const std::string& depthEncoding() {
        std::string fault = "it has no encoding";
        for (std::size_t i = 0; i < pairs_.size() && encoding_.empty(); i++) {
            try {
                encoding_ = read(depth_, pairs_[i].second).encoding();
            } catch (const std::runtime_error& error) {
                fault = error.what();
            }
        }
        if (encoding_.empty())
            throw std::runtime_error(nameOf(*bag_, depth_.name, pairs_.back().second) + ": " + fault);
        return encoding_;
    }

    cv::Mat colour(std::size_t i) override {
        return named(colour_, pairs_.at(i).first, [&] { return read(colour_, pairs_[i].first).colour(); });
    }

    cv::Mat depth(std::size_t i) override {
        return named(depth_, pairs_.at(i).second, [&] {
            const BagImage image = read(depth_, pairs_[i].second);
            if (image.encoding() != encoding_)
                throw std::runtime_error("encoding " + excerpt(image.encoding()) + ", where others have " +
                                         excerpt(encoding_));
            return image.depth(too_far_[i]);
        });
    }

    std::string warning() const override {
        const std::size_t all = std::accumulate(too_far_.begin(), too_far_.end(), std::size_t{0});
        return all == 0 ? std::string() : tooFarText(all);
    }

  private:
    BagImage read(const BagTopic& topic, std::size_t message) const {
        return {topic, bag_->message(topic.name, message)};
    }

    /// @throws what `decode` throws with the message's name before it
    template <class Decode>
    cv::Mat named(const BagTopic& topic, std::size_t message, const Decode& decode) const {
        try {
            return decode();
        } catch (const std::runtime_error& error) {
            throw std::runtime_error(nameOf(*bag_, topic.name, message) + ": " + error.what());
        }
    }

    std::shared_ptr<const BagFile> bag_;
    BagTopic colour_, depth_;
    std::vector<std::pair<std::size_t, std::size_t>> pairs_;  ///< numbers of messages
    std::vector<std::size_t> too_far_;                        ///< of each pair, once it was read
    std::string encoding_;
};

/// The stamps of a topic's messages, ascending, each once.
std::vector<Stamped> readStamps(const BagFile& bag, const std::string& topic, DatasetDescription& out) {
    std::vector<Stamped> stamps;
    std::size_t left_out = 0;
    for (std::size_t i = 0; i < bag.count(topic); i++) {
        std::string fault;
        try {
            const double time = bag.stamp(topic, i);
            if (time > 0)
                stamps.push_back({time, i});
            else
                fault = "its header has no time stamp";
        } catch (const std::runtime_error& error) {
            fault = error.what();
        }
        if (!fault.empty() && ++left_out <= kMostReasons)
            out.notes.push_back("left out: " + topic + ", message " + std::to_string(i + 1) + ": " + fault);
    }
    if (left_out > kMostReasons)
        out.notes.push_back("left out: and " + std::to_string(left_out - kMostReasons) + " more");
    std::stable_sort(stamps.begin(), stamps.end(),
                     [](const Stamped& a, const Stamped& b) { return a.timestamp < b.timestamp; });
    const auto last = std::unique(stamps.begin(), stamps.end(), [](const Stamped& a, const Stamped& b) {
        return a.timestamp == b.timestamp;
    });
    out.association.duplicates += static_cast<std::size_t>(stamps.end() - last);
    stamps.erase(last, stamps.end());
    return stamps;
}

std::string noPairText(const BagTopicNames& topics, const std::vector<double>& colour,
                       const std::vector<double>& depth, double max_difference) {
    const double closest = smallestDifference(colour, depth);
    char text[160];
    std::snprintf(text, sizeof text, " within %g s (%zu colour, %zu depth images, closest pair %.3g s apart)",
                  max_difference, colour.size(), depth.size(), closest);
    return "no image of " + topics.colour + " has one of " + topics.depth + text +
           (std::isfinite(closest) ? ": see --max-dt of rgbd2rawlog" : "");
}

Pose findDepthColour(const BagFile& bag, const BagTopic& depth, const BagTopic& colour) {
    auto found = FrameTree::ofStatic(bag).find(depth.frame_id, colour.frame_id);
    if (!found) found = FrameTree::ofAll(bag).find(depth.frame_id, colour.frame_id);
    if (found) return *found;
    throw std::runtime_error(bag.path() +
                             ": depth is not aligned to colour, and neither /tf_static nor /tf joins "
                             "their frames '" +
                             excerpt(depth.frame_id) + "' and '" + excerpt(colour.frame_id) +
                             "': record /tf_static, or aligned depth");
}

}  // namespace

BagCameras readCameras(const BagFile& bag, const BagTopicNames& topics) {
    const BagTopic &colour = *bag.find(topics.colour), &depth = *bag.find(topics.depth);
    BagCameras out;
    const auto use = [&](const std::string& info, const BagTopic& images, bool of_depth) {
        const BagCamera found = readCamera(bag, info, images, of_depth);
        if (!found.warning.empty()) out.notes.push_back("warning: " + found.warning);
        return found;
    };
    const BagCamera colour_camera = use(topics.colour_info, colour, false);
    out.colour = out.depth = colour_camera.camera;
    out.source = colour_camera.source;
    const bool same_frame = depth.frame_id == colour.frame_id;
    if (topics.depth_info.empty()) {
        if (!same_frame)
            throw std::runtime_error(bag.path() + ": " + depth.name + " is in frame '" +
                                     excerpt(depth.frame_id) + "', not in that of " + colour.name +
                                     ", and has no camera_info: record it, "
                                     "choose it by --depth-info-topic, or record aligned depth");
    } else {
        out.depth = use(topics.depth_info, depth, true).camera;
    }
    if (!same_frame) out.T_depth_colour = findDepthColour(bag, depth, colour);
    out.aligned = out.depth == out.colour && out.T_depth_colour.isApprox(Pose::Identity(), 1e-9);
    if (out.aligned) {
        out.notes.emplace_back("depth is aligned to colour");
        return out;
    }
    char text[160];
    std::snprintf(
        text, sizeof text,
        "depth is not aligned to colour: it is registered from its own camera, %dx%d fx %g, %.1f mm "
        "away",
        out.depth.width, out.depth.height, out.depth.fx, 1e3 * out.T_depth_colour.translation().norm());
    out.notes.push_back(
        text + (same_frame ? " (same frame, other intrinsics; should its pixels be those of colour all the "
                             "same: --depth-info-topic " +
                                 topics.colour_info + ")"
                           : " (by " + topics.depth_info + " and the bag's transforms)"));
    return out;
}

DatasetDescription loadBag(const std::string& path, const DatasetOptions& options) {
    const auto bag = std::make_shared<const BagFile>(path);
    const BagTopicNames topics = chooseTopics(*bag, options.topics);
    const BagTopic &colour = *bag->find(topics.colour), &depth = *bag->find(topics.depth);
    DatasetDescription out;
    out.folder = path;
    out.format = "bag";
    out.sensor_label = colour.frame_id.empty() ? colour.name : colour.frame_id;
    out.notes.push_back("colour: " + colour.toText());
    out.notes.push_back("depth: " + depth.toText());

    const BagCameras cameras = readCameras(*bag, topics);
    out.camera = cameras.colour;
    out.camera_source = cameras.source;
    if (!cameras.aligned)
        out.registration = DepthRegistration{cameras.depth, cameras.T_depth_colour.inverse()};
    out.notes.insert(out.notes.end(), cameras.notes.begin(), cameras.notes.end());
    for (const std::string& damage : bag->damage()) out.notes.push_back("left out: " + damage);

    const auto colour_stamps = readStamps(*bag, topics.colour, out);
    const auto depth_stamps = readStamps(*bag, topics.depth, out);
    const auto colour_times = stampsOf(colour_stamps), depth_times = stampsOf(depth_stamps);
    const auto images = std::make_shared<BagImages>(bag, topics);
    for (const StampMatch& match : associateStamps(colour_times, depth_times, options.max_time_difference)) {
        const Stamped &c = colour_stamps[match.first], &d = depth_stamps[match.second];
        images->add(c.message, d.message);
        out.frames.push_back({c.timestamp, d.timestamp, nameOf(*bag, topics.colour, c.message),
                              nameOf(*bag, topics.depth, d.message)});
    }
    if (out.frames.empty())
        throw std::runtime_error(path + ": " +
                                 noPairText(topics, colour_times, depth_times, options.max_time_difference));
    out.association.dropped_colour = colour_times.size() - out.frames.size();
    out.association.dropped_depth = depth_times.size() - out.frames.size();
    finishFrames(out);  // their order is that of time already, so that of `images`

    const double unit = realsense::depthUnit(*bag, topics.depth);
    const std::string encoding = images->depthEncoding();
    out.depth_scale = unit > 0 && encoding != "32FC1" ? unitsPerMetre(unit) : depthUnitsPerMetre(encoding);
    out.images = images;

    std::filesystem::path beside = std::filesystem::path(path).lexically_normal();
    if (!beside.has_filename()) beside = beside.parent_path();
    beside.replace_filename(beside.stem().string() + "_groundtruth.txt");
    out.ground_truth = readGroundTruth(beside.string());
    return out;
}

}  // namespace roevo
