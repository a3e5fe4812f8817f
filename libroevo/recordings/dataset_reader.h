#pragma once
#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "recordings/association_report.h"
#include "recordings/bags/topic_names.h"
#include "recordings/folder_choice.h"
#include "recordings/sensor_data.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"

namespace roevo {

/// One colour image and its depth image.
struct DatasetEntry {
    double timestamp = 0;        ///< s, of the colour image, to the microsecond
    double depth_timestamp = 0;  ///< s
    std::string image, depth;    ///< paths that can be opened; names for people where an ImageStore is
};

/// Depth that was taken by a camera of its own, as the images hold it.
struct DepthRegistration {
    PinholeCamera depth_camera;
    Pose T_colour_depth = Pose::Identity();
};

/// Where the images are that are no files of their own: the frames of a dataset, by number. Not for two
/// threads at a time.
class ImageStore {
  public:
    virtual ~ImageStore() = default;
    /// CV_8UC3 (BGR) or CV_8UC1. @throws std::runtime_error naming the image
    virtual cv::Mat colour(std::size_t i) = 0;
    /// CV_16UC1. @throws std::runtime_error naming the image
    virtual cv::Mat depth(std::size_t i) = 0;
    /// Once read: what was lost; one line or empty.
    virtual std::string warning() const = 0;
};

/// What a format's loader finds out about a recording.
struct DatasetDescription {
    std::string folder;        ///< or the bag
    std::string format;        ///< "tum", "icl", "eth3d", "7scenes", "plain" or "bag"
    std::string sensor_label;  ///< the camera's name where the recording has one
    PinholeCamera camera;
    std::string camera_source;        ///< in words: where the intrinsics come from
    double depth_scale = 0;           ///< units per metre of the depth images; 0: not told
    std::uint16_t invalid_depth = 0;  ///< value that stands for "unknown" in the images, beside 0
    std::optional<DepthRegistration> registration;  ///< empty: depth and colour pixels are the same
    std::vector<std::string> notes;                 ///< what was assumed or converted, a line each
    std::vector<DatasetEntry> frames;
    double time_unit = 1;                ///< per second, that the images' stamps were written in
    double frame_rate = 0;               ///< Hz, of images that are numbered; 0: they have times
    double told_rate = 0;                ///< Hz, that the camera's file says; 0: none
    std::shared_ptr<ImageStore> images;  ///< none: images are files
    AssociationReport association;
    GroundTruth ground_truth;    ///< of the colour camera, optical axes; empty when there is none
    std::vector<ImuSample> imu;  ///< ascending in time; empty when the dataset has none
    std::string imu_source;      ///< in words: file, what was left out of it
};

struct DatasetOptions {
    std::string format = "auto";
    double max_time_difference = 0.02;  ///< s, between a colour and its depth image
    /// Listed images that are not there: go on, the frame cannot be read then; else openDataset() throws.
    bool tolerate_missing = false;
    BagTopicNames topics{};      ///< of bags
    FolderChoice folder{};       ///< of folders
    std::string ground_truth{};  ///< file in place of what lies in the folder, converted alike; empty: that
};

/// An RGB-D dataset in a folder or a bag, read frame by frame.
class DatasetReader {
  public:
    /// Checks that the files are there and that the first readable depth image makes sense.
    /// @throws std::runtime_error with one line that says what is wrong and what to do.
    explicit DatasetReader(DatasetDescription description, bool tolerate_missing = false);

    const DatasetDescription& description() const { return description_; }
    const PinholeCamera& camera() const { return description_.camera; }
    const PinholeCamera& depthCamera() const;  ///< of the depth images; mostly camera(), too
    double depthScale() const { return description_.depth_scale; }  ///< units per metre of readDepth()
    float depthUnit() const;                                        ///< metres per unit
    const GroundTruth& groundTruth() const { return description_.ground_truth; }
    const std::vector<ImuSample>& imu() const { return description_.imu; }

    /// The dataset's own trajectory file when it can be copied as it is (GroundTruth::copyable), else "".
    std::string groundTruthPath() const {
        return groundTruth().copyable ? groundTruth().file : std::string();
    }

    std::size_t size() const { return description_.frames.size(); }
    const DatasetEntry& entry(std::size_t i) const { return description_.frames.at(i); }

    /// Depth as stored, in the depth camera's pixels: CV_16UC1 of depthScale() units per metre, 0 where
    /// unknown (whatever the description's value for that is). Images of floats are rounded to 0.2 mm.
    /// @throws std::runtime_error when frame i's depth is unreadable or of another size.
    cv::Mat readDepth(std::size_t i) const;

    /// What readDepth() gave, as frames have it: CV_32FC1 metres in the colour image's pixels. Where the
    /// depth camera is another one, registered just as the frames of a rawlog with these cameras are.
    cv::Mat toFrameDepth(const cv::Mat& depth_u16) const;

    /// Colour as stored, CV_8UC3 (BGR) or CV_8UC1. @throws std::runtime_error as readDepth().
    cv::Mat readImage(std::size_t i) const;

    /// Frame i, ready for the odometry. @throws std::runtime_error when one of its images is unusable; others
    /// still are usable.
    RgbdFrame readFrame(std::size_t i) const;

    /// Once read: what was lost; one line or empty.
    std::string warning() const;

    /// The camera with its source; how the images were matched; then a line for every note, the ground truth
    /// and the inertial samples.
    std::string summary() const;

    /// What summary() says from its third line on.
    std::vector<std::string> notes() const;

  private:
    cv::Mat readStoredDepth(std::size_t i) const;
    void checkSize(const cv::Mat& image, const PinholeCamera& camera, const std::string& file) const;
    void checkFiles(bool tolerate_missing);
    void checkDepthScale();
    void settleDepthScale(const cv::Mat& first, const std::string& file);
    void noteFacts(const cv::Mat& depth, double median_depth);

    DatasetDescription description_;
    Pose T_colour_depth_ = Pose::Identity();  ///< of the registration
    double floats_per_metre_ = 0;             ///< of depth images of floats; 0: they are of 16 bits
    mutable std::vector<std::size_t>
        too_far_;  ///< of each frame's depths, once read: those that 16 bits cannot hold
};

/// Opens a dataset folder or a bag. @param options.format  "auto" or one of datasetFormats()
/// @throws std::runtime_error with one line that says what is wrong and what to do.
DatasetReader openDataset(const std::string& folder, const DatasetOptions& options = {});

std::vector<std::string> datasetFormats();

}  // namespace roevo
