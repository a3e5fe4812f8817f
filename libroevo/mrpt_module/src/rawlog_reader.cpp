#include "roevo_mrpt/rawlog_reader.h"

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <new>
#include <stdexcept>
#include <utility>

#include "checked_memory.h"
#include "embedded_jpegs.h"
#include "input/excerpt.h"
#include "input/regular_file.h"
#include "range_file.h"
#include "roevo_mrpt/rawlog_writer.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

using mrpt::obs::CObservation3DRangeScan;

constexpr std::size_t kInterleaved = 30;  // sensors that record together take turns at least this often
constexpr char kNoName[] = "(no name)";

}  // namespace

// Not in the unnamed namespace: RawlogReader::Impl, which has linkage, has one
/// Remembers how far it got and whether it ran dry, which tells a proper end from a cut one; keeps damaged
/// images from MRPT.
class WatchedStream {
  public:
    mrpt::io::CFileGZInputStream file;
    std::uint64_t bytes = 0;
    bool ran_dry = false;
    EmbeddedJpegs jpegs;

    size_t Read(void* data, size_t count) {
        // MRPT adds to a length that it has read, and makes room for the sum
        if (count > kLargestMrptBlock) throw std::length_error("more than any observation holds");
        size_t got = file.Read(data, count);
        if (got > count) got = 0;  // zlib's -1: damaged data
        if (got < count) ran_dry = true;
        bytes += got;
        jpegs.examine(static_cast<std::uint8_t*>(data), got, count);
        return got;
    }
    size_t Write(const void*, size_t) { throw std::logic_error("input stream"); }
    std::string getStreamDescription() const { return file.getStreamDescription(); }
};

namespace {

/// MRPT puts any byte of a damaged file into these; only 0 and 1 are values that C++ knows.
void makeFlagsSound(CObservation3DRangeScan& scan) {
    for (bool* flag : {&scan.hasPoints3D, &scan.hasRangeImage, &scan.hasIntensityImage,
                       &scan.hasConfidenceImage, &scan.range_is_depth}) {
        unsigned char byte = 0;
        std::memcpy(&byte, flag, sizeof byte);
        *flag = byte != 0;
    }
}

/// Whether it can be seen: a file behind a folder that may not be entered costs its frame, not the run.
bool isThere(const fs::path& file) {
    std::error_code unreadable;
    return fs::exists(file, unreadable);
}

/// Where this rawlog's external files are: <stem>_Images, or the spellings that MRPT's own programs accept.
fs::path findImagesDirectory(const fs::path& rawlog) {
    const fs::path usual = RawlogWriter::imagesDirectory(rawlog.string());
    const std::string stem = rawlog.stem().string();
    for (const fs::path& candidate :
         {usual, rawlog.parent_path() / (stem + "_images"), rawlog.parent_path() / (stem + "_IMAGES"),
          rawlog.parent_path() / "Images"}) {
        std::error_code unreadable;
        if (fs::is_directory(candidate, unreadable)) return fs::absolute(candidate);
    }
    return fs::absolute(usual);
}

/// Uncompressed length modulo 2^32 from the trailer of a gz file, or the length of any other file.
double statedSize(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::array<unsigned char, 4> b{};
    in.read(reinterpret_cast<char*>(b.data()), 2);
    if (!in || b[0] != 0x1f || b[1] != 0x8b) return static_cast<double>(fs::file_size(file));
    in.seekg(-4, std::ios::end);
    in.read(reinterpret_cast<char*>(b.data()), 4);
    return in ? b[0] + 256.0 * (b[1] + 256.0 * (b[2] + 256.0 * b[3])) : 0.0;
}

/// Only gz is read as it is.
void requireNotPacked(const std::string& file) {
    char head[4] = {};
    std::ifstream(file, std::ios::binary).read(head, sizeof head);
    for (const auto& [magic, program] : {std::pair("\x28\xB5\x2F\xFD", "zstd"), {"\xFD\x37\x7A\x58", "xz"}})
        if (std::memcmp(head, magic, sizeof head) == 0)
            throw std::runtime_error(file + " is packed by " + program + ": unpack it first (" + program +
                                     " -d), or pack it by gzip");
}

std::string listCounts(const std::map<std::string, std::size_t>& counts) {
    std::string text;
    for (const auto& [name, count] : counts)
        text += (text.empty() ? "" : ", ") + std::to_string(count) + " " +
                (name.empty() ? kNoName : excerpt(name));
    return text.empty() ? "nothing" : text;
}

/// " ('name')" of the class that MRPT's message says it does not know, or "".
std::string unknownClass(const std::string& message) {
    const std::string before = "has class '";
    const std::size_t begin = message.find(before), end = message.find("' which is not registered");
    if (begin == std::string::npos || end == std::string::npos) return {};
    const std::size_t name = begin + before.size();
    return " ('" + excerpt(message.substr(name, end - name)) + "')";
}

std::size_t sumOf(const std::map<std::string, std::size_t>& counts) {
    std::size_t sum = 0;
    for (const auto& [name, count] : counts) sum += count;
    return sum;
}

void append(std::string& text, const std::string& more) {
    text += (text.empty() ? "" : "; ") + more;
}

}  // namespace

std::string RawlogReport::warning() const {
    std::string text = fault;
    if (labels.size() > 1 && !label_chosen)
        append(text, "several sensors have range images (" + listCounts(labels) + "), using '" +
                         excerpt(label) + "' (choose with --sensor-label)");
    if (const std::size_t left_out = sumOf(points_only); left_out > 0)
        append(text, std::to_string(left_out) + " scan(s) with 3D points but no range image left out (" +
                         listCounts(points_only) + ")");
    if (const auto blind = without_range.find(label); blind != without_range.end())
        append(text, std::to_string(blind->second) + " scan(s) of " +
                         (label.empty() ? kNoName : excerpt(label)) + " without a range image left out");
    if (damaged_images > 0)
        append(text, std::to_string(damaged_images) + (damaged_images == 1 ? " entry" : " entries") +
                         " with a damaged JPEG image, which is left out (" + first_damaged_image + ")");
    return text;
}

struct RawlogReader::Impl {
    std::string path;
    fs::path images;
    bool any_label = true;
    WatchedStream stream;
    std::deque<mrpt::serialization::CSerializable::Ptr> queue;  // what the entry read last holds
    RawlogReport report;
    std::function<void(const mrpt::obs::CObservation&)> on_other;
    std::function<void(const mrpt::obs::CActionCollection&)> on_actions;
    bool at_end = false;
    double stated_size = 0, compressed_size = 0;  // bytes

    /// Best guess of the uncompressed size. gz files state it modulo 4 GiB; MRPT's stream does not tell the
    /// compressed position.
    double uncompressedSize() const {
        double size = stated_size;
        while (size < static_cast<double>(stream.bytes) || size < 0.99 * compressed_size)
            size += 4.0 * 1024 * 1024 * 1024;
        return size;
    }

    /// Reads one top-level object into the queue; false at the end.
    bool readEntry() {
        const std::uint64_t start = stream.bytes;
        mrpt::serialization::CSerializable::Ptr object;
        try {
            object = mrpt::serialization::archiveFrom(stream).ReadObject();
        } catch (const std::bad_alloc&) {
            throw;  // there may be nothing wrong with the file
        } catch (const std::exception& fault) {
            noteEnd(stream.bytes - start, unknownClass(fault.what()));
            return false;
        }
        if (!object) return noteEnd(1, ""), false;
        report.entries++;
        enqueue(object);
        if (const std::string damage = stream.jpegs.takeDamage(); !damage.empty()) noteDamagedImages(damage);
        return true;
    }

    /// Leaves the scans of this entry without their image where a single pixel is in its place.
    void noteDamagedImages(const std::string& damage) {
        if (report.damaged_images++ == 0)
            report.first_damaged_image = "entry " + std::to_string(report.entries) + ": " + damage;
        for (const auto& object : queue)
            if (const auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(object))
                if (EmbeddedJpegs::isReplacement(scan->intensityImage)) scan->hasIntensityImage = false;
    }

    void noteEnd(std::uint64_t bytes_into_object, const std::string& unknown_class) {
        at_end = true;
        if (stream.ran_dry && bytes_into_object == 0 && report.entries > 0) return;
        if (report.entries == 0)
            throw std::runtime_error(path + (stream.bytes == 0
                                                 ? " is empty or damaged"
                                                 : " is not a rawlog (its first object cannot be read)"));
        report.fault = path +
                       (stream.ran_dry ? " is truncated: it ends in the middle of entry "
                                       : " is damaged or holds an unknown class" + unknown_class +
                                             ": reading stopped at entry ") +
                       std::to_string(report.entries + 1) + "; what came before was kept";
    }

    void enqueue(const mrpt::serialization::CSerializable::Ptr& object) {
        using namespace mrpt::obs;
        if (const auto frame = std::dynamic_pointer_cast<CSensoryFrame>(object)) {
            for (const auto& each : *frame) queue.push_back(each);
        } else if (const auto whole = std::dynamic_pointer_cast<CRawlog>(object)) {
            for (std::size_t i = 0; i < whole->size(); i++) enqueue(whole->getAsGeneric(i));
        } else {
            queue.push_back(object);
        }
    }

    /// Counts the object; what it is as a scan with a range image, or null.
    CObservation3DRangeScan::Ptr classify(const mrpt::serialization::CSerializable::Ptr& object) {
        report.classes[object->GetRuntimeClass()->className]++;
        auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(object);
        if (!scan) return nullptr;
        makeFlagsSound(*scan);
        if (!scan->hasRangeImage) {
            (scan->hasPoints3D ? report.points_only : report.without_range)[scan->sensorLabel]++;
            return nullptr;
        }
        if (any_label && report.labels.empty()) report.label = scan->sensorLabel;
        report.labels[scan->sensorLabel]++;
        return scan;
    }

    /// The object as a scan of the wanted sensor, or null.
    CObservation3DRangeScan::Ptr accept(const mrpt::serialization::CSerializable::Ptr& object) {
        auto scan = classify(object);
        if (scan && scan->sensorLabel == report.label) {
            report.range_images++;
            return scan;
        }
        if (scan && any_label && report.range_images <= kInterleaved) throwAmbiguous();
        using namespace mrpt::obs;
        if (const auto* observation = dynamic_cast<const CObservation*>(object.get());
            observation && on_other)
            on_other(*observation);
        if (const auto* actions = dynamic_cast<const CActionCollection*>(object.get()); actions && on_actions)
            on_actions(*actions);
        return nullptr;
    }

    [[noreturn]] void throwAmbiguous() {
        do {
            for (; !queue.empty(); queue.pop_front()) classify(queue.front());
        } while (!at_end && readEntry());
        throw std::runtime_error(path + ": several sensors have range images (" + listCounts(report.labels) +
                                 "): choose one with --sensor-label");
    }

    /// Makes the scan independent of MRPT's global search path for external files.
    void locateFiles(CObservation3DRangeScan& scan) const {
        if (scan.intensityImage.isExternallyStored()) {
            const fs::path file = scan.intensityImage.getExternalStorageFile();
            fs::path found = images / file;  // an absolute file stays as it is
            if (!isThere(found) && isThere(images.parent_path() / file)) found = images.parent_path() / file;
            // Of a recording that was moved, or made on Windows
            const std::string name = file.string().substr(file.string().find_last_of("/\\") + 1);
            if (!isThere(found) && isThere(images / name)) found = images / name;
            scan.intensityImage.setExternalStorage(found.string());
        }
        if (!scan.rangeImage_isExternallyStored()) return;
        const fs::path file = scan.rangeImage_getExternalStorageFile("");
        const bool beside = !isThere(images / file) && isThere(images.parent_path() / file);
        loadRangeFile(scan, (beside ? images.parent_path() : images).string());
    }

    [[noreturn]] void throwNothingFound() const {
        const std::string note = report.fault.empty() ? "" : " (" + report.fault + ")";
        if (!report.labels.empty())
            throw std::runtime_error(path + ": no range images of sensor '" + excerpt(report.label) +
                                     "'; sensors with range images: " + listCounts(report.labels) + note);
        if (!report.points_only.empty())
            throw std::runtime_error(
                path + ": the scans hold 3D points, but no range images (" + listCounts(report.points_only) +
                "); the odometry needs the depth image: record again with range images (grab_depth = true)" +
                note);
        throw std::runtime_error(path + ": no range images (CObservation3DRangeScan with depth); it holds " +
                                 listCounts(report.classes) + note);
    }
};

RawlogReader::RawlogReader(const std::string& path, const std::string& sensor_label)
    : impl_(std::make_unique<Impl>()) {
    useCheckedMrptMemory();
    std::error_code error;
    if (!fs::exists(path, error))
        throw std::runtime_error(error ? "cannot read " + path + ": " + error.message()
                                       : "rawlog not found: " + path);
    requireRegularInput(path);
    requireNotPacked(path);
    if (!impl_->stream.file.open(path)) throw std::runtime_error("cannot read " + path);
    impl_->path = path;
    impl_->compressed_size = static_cast<double>(fs::file_size(path));
    impl_->stated_size = statedSize(path);
    impl_->images = findImagesDirectory(path);
    impl_->any_label = sensor_label.empty();
    impl_->report.label_chosen = !sensor_label.empty();
    impl_->report.label = sensor_label == kNoName ? "" : sensor_label;
}

RawlogReader::~RawlogReader() = default;

CObservation3DRangeScan::Ptr RawlogReader::next() {
    Impl& m = *impl_;
    for (;;) {
        while (!m.queue.empty()) {
            const auto object = m.queue.front();
            m.queue.pop_front();
            if (auto scan = m.accept(object)) {
                m.locateFiles(*scan);
                return scan;
            }
        }
        if (m.at_end || !m.readEntry()) break;
    }
    if (m.report.range_images == 0) m.throwNothingFound();
    return nullptr;
}

void RawlogReader::onOther(std::function<void(const mrpt::obs::CObservation&)> listener) {
    impl_->on_other = std::move(listener);
}

void RawlogReader::onActions(std::function<void(const mrpt::obs::CActionCollection&)> listener) {
    impl_->on_actions = std::move(listener);
}

double RawlogReader::progress() const {
    return std::min(1.0, static_cast<double>(impl_->stream.bytes) / impl_->uncompressedSize());
}

const RawlogReport& RawlogReader::report() const {
    return impl_->report;
}

}  // namespace roevo
