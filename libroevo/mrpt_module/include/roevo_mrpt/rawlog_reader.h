#pragma once
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace mrpt::obs {
class CActionCollection;
class CObservation;
class CObservation3DRangeScan;
}  // namespace mrpt::obs

namespace roevo {

/// What a rawlog held, as far as it was read.
struct RawlogReport {
    std::size_t entries = 0;                     ///< objects at the top level of the file
    std::size_t range_images = 0;                ///< scans handed out by next()
    std::map<std::string, std::size_t> classes;  ///< class name -> how many observations (and other entries)
    std::map<std::string, std::size_t> labels;   ///< sensor label -> how many scans with a range image
    std::map<std::string, std::size_t>
        points_only;  ///< sensor label -> scans with 3D points, but no range image
    std::map<std::string, std::size_t> without_range;  ///< sensor label -> scans with neither
    std::size_t damaged_images = 0;   ///< entries with a JPEG image inside that cannot be decoded
    std::string first_damaged_image;  ///< the first of them, and what libjpeg says
    std::string label;                ///< the sensor that is being read
    bool label_chosen = false;        ///< the caller named it, so that other sensors are left out on purpose
    std::string fault;                ///< why reading stopped before a proper end; empty when all is well

    /// Things the user should hear (damage, other cameras left out), one line, or "".
    std::string warning() const;
};

/// Streams the RGB-D observations of a rawlog one by one: both rawlog formats (observations only, or pairs of
/// actions and sensory frames), gz or plain, images inside or in files beside it. Memory does not grow with
/// the file.
class RawlogReader {
  public:
    /// @param sensor_label  read only this sensor, "(no name)" for one without a label; empty: the only one
    /// with range images
    /// @throws std::runtime_error when the file is missing or is not a rawlog.
    explicit RawlogReader(const std::string& path, const std::string& sensor_label = "");
    ~RawlogReader();
    RawlogReader(const RawlogReader&) = delete;
    RawlogReader& operator=(const RawlogReader&) = delete;

    /// The next scan that has a range image, or null at the end. Its depth is in memory (empty when it is in
    /// an external file that cannot be read: toRgbdFrame() names it); an external colour image is not decoded
    /// yet, but its path is absolute. A damaged JPEG inside the rawlog is replaced by one pixel, and
    /// hasIntensityImage is false: toRgbdFrame() names it. A file that ends in the middle of an object ends
    /// here too: see report().fault.
    /// @throws std::runtime_error at the end of a file without a single usable scan (naming what it holds),
    /// when the first object cannot be read, or when no sensor was chosen and a second one turns up among the
    /// first scans (listing all with their counts; one that turns up later is left out with a warning).
    std::shared_ptr<mrpt::obs::CObservation3DRangeScan> next();

    /// Called by next() with every observation that it does not hand out, in the order of the file.
    void onOther(std::function<void(const mrpt::obs::CObservation&)> listener);
    /// The same of actions.
    void onActions(std::function<void(const mrpt::obs::CActionCollection&)> listener);

    /// How much of the file has been read, 0 to 1.
    double progress() const;

    const RawlogReport& report() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace roevo
