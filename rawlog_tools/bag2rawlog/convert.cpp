#include "bag2rawlog/convert.h"

#include <sensor_msgs/Image.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "bag2rawlog/ros_image.h"
#include "evaluation/association.h"
#include "input/excerpt.h"
#include "programs/interrupt.h"
#include "programs/progress.h"
#include "roevo_mrpt/rawlog_writer.h"

namespace roevo {
namespace {

constexpr std::size_t kMostReasons = 10;

using Messages = std::vector<rosbag::MessageInstance>;

/// A message of a topic, by its header's stamp.
struct Stamped {
    double timestamp = 0;
    std::size_t message = 0;
};

/// To the microsecond: whole numbers below 2^53 divide to the nearest double.
double secondsOf(const ros::Time& stamp) {
    const double micro = std::round(static_cast<double>(stamp.nsec) / 1000);
    return (static_cast<double>(stamp.sec) * 1e6 + micro) / 1e6;
}

/// @throws std::runtime_error when the message cannot be read.
boost::shared_ptr<sensor_msgs::Image> imageOf(const rosbag::MessageInstance& message) {
    auto image = message.instantiate<sensor_msgs::Image>();
    if (!image) throw std::runtime_error("not the Image of ROS 1 (another version of the message)");
    return image;
}

void leaveOut(BagConversion& result, const std::string& topic, std::size_t number, const std::string& why) {
    result.left_out++;
    if (result.reasons.size() < kMostReasons)
        result.reasons.push_back(topic + ", message " + std::to_string(number + 1) + ": " + why);
}

/// The stamps of a topic's usable messages, ascending, each once.
std::vector<Stamped> stampsOf(const Messages& messages, const std::string& topic, BagConversion& result) {
    std::vector<Stamped> stamps;
    for (std::size_t i = 0; i < messages.size(); i++) {
        try {
            const double time = secondsOf(imageOf(messages[i])->header.stamp);
            if (time == 0) throw std::runtime_error("its header has no time stamp");
            stamps.push_back({time, i});
        } catch (const std::exception& error) {
            leaveOut(result, topic, i, error.what());
        }
    }
    std::stable_sort(stamps.begin(), stamps.end(),
                     [](const Stamped& a, const Stamped& b) { return a.timestamp < b.timestamp; });
    const auto last = std::unique(stamps.begin(), stamps.end(), [](const Stamped& a, const Stamped& b) {
        return a.timestamp == b.timestamp;
    });
    result.association.duplicates += static_cast<std::size_t>(stamps.end() - last);
    stamps.erase(last, stamps.end());
    return stamps;
}

std::vector<double> timesOf(const std::vector<Stamped>& stamps) {
    std::vector<double> times;
    for (const Stamped& stamped : stamps) times.push_back(stamped.timestamp);
    return times;
}

std::string noPairText(const BagTopicNames& topics, const std::vector<double>& colour,
                       const std::vector<double>& depth, double max_difference) {
    const double closest = smallestDifference(colour, depth);
    char text[160];
    std::snprintf(text, sizeof text, " within %g s (%zu colour, %zu depth images, closest pair %.3g s apart)",
                  max_difference, colour.size(), depth.size(), closest);
    return "no image of " + topics.colour + " has one of " + topics.depth + text +
           (std::isfinite(closest) ? ": see --max-dt" : "");
}

void report(const std::vector<StampMatch>& matches, const std::vector<double>& colour,
            const std::vector<double>& depth, AssociationReport& out) {
    out.matched = matches.size();
    out.dropped_colour = colour.size() - matches.size();
    out.dropped_depth = depth.size() - matches.size();
    for (std::size_t i = 0; i < matches.size(); i++) {
        const double time = colour[matches[i].first];
        out.largest_difference = std::max(out.largest_difference, std::abs(depth[matches[i].second] - time));
        if (i > 0) out.largest_gap = std::max(out.largest_gap, time - colour[matches[i - 1].first]);
    }
}

}  // namespace

BagConversion convertBag(const BagFile& bag, const BagTopicNames& topics, const BagCameras& cameras,
                         double max_time_difference, const std::string& rawlog) {
    BagConversion result;
    const Messages colour = bag.messages(topics.colour), depth = bag.messages(topics.depth);
    const auto colour_stamps = stampsOf(colour, topics.colour, result);
    const auto depth_stamps = stampsOf(depth, topics.depth, result);
    const auto colour_times = timesOf(colour_stamps), depth_times = timesOf(depth_stamps);
    const auto matches = associateStamps(colour_times, depth_times, max_time_difference);
    if (matches.empty())
        throw std::runtime_error(bag.path() + ": " +
                                 noPairText(topics, colour_times, depth_times, max_time_difference));
    report(matches, colour_times, depth_times, result.association);

    const std::string encoding = imageOf(depth[depth_stamps.front().message])->encoding;
    RawlogWriterOptions options;
    options.sensor_label = cameras.label;
    options.range_units = depthUnitOf(encoding);
    if (!cameras.aligned) options.depth_camera = DepthCamera{cameras.depth, cameras.T_depth_colour};
    const InterruptGuard guard;
    RawlogWriter writer(rawlog, cameras.colour, options);
    Progress progress("writing", matches.size());
    const auto checkSize = [](const cv::Mat& image, const PinholeCamera& camera) {
        if (image.cols != camera.width || image.rows != camera.height)
            throw std::runtime_error("the image is " + std::to_string(image.cols) + "x" +
                                     std::to_string(image.rows) + ", but its camera_info is for " +
                                     std::to_string(camera.width) + "x" + std::to_string(camera.height));
    };
    for (std::size_t i = 0; i < matches.size(); i++) {
        InterruptGuard::check();
        const Stamped& c = colour_stamps[matches[i].first];
        const Stamped& d = depth_stamps[matches[i].second];
        cv::Mat colour_image, depth_image;
        const std::string* topic = &topics.colour;
        std::size_t number = c.message;
        try {
            colour_image = colourImageOf(*imageOf(colour[c.message]));
            checkSize(colour_image, cameras.colour);
            topic = &topics.depth, number = d.message;
            const auto depth_message = imageOf(depth[d.message]);
            if (depth_message->encoding != encoding)
                throw std::runtime_error("encoding " + excerpt(depth_message->encoding) +
                                         ", where others have " + excerpt(encoding));
            depth_image = depthImageOf(*depth_message, result.too_far);
            checkSize(depth_image, cameras.depth);
        } catch (const std::exception& error) {
            leaveOut(result, *topic, number, error.what());
            continue;
        }
        writer.add(c.timestamp, depth_image, colour_image);
        progress.update(++result.written);
    }
    if (result.written == 0)
        throw std::runtime_error(bag.path() + ": no usable frame; the first of " +
                                 std::to_string(result.left_out) + " faults: " + result.reasons.front());
    progress.finish();
    writer.finish();
    return result;
}

}  // namespace roevo
