#include "rgbd2rawlog/convert.h"

#include <filesystem>
#include <stdexcept>

#include "roevo_mrpt/rawlog_writer.h"
#include "support/progress.h"

namespace roevo {

ConvertResult convertToRawlog(const DatasetReader& dataset, const std::string& rawlog, bool skip_bad) {
    RawlogWriterOptions options;
    options.range_units = dataset.depthUnit();
    RawlogWriter writer(rawlog, dataset.camera(), options);
    ConvertResult result;
    Progress progress("writing", dataset.size());
    for (std::size_t i = 0; i < dataset.size(); i++) {
        cv::Mat depth;
        try {
            depth = dataset.readDepth(i);
            dataset.readImage(i);
        } catch (const std::runtime_error& error) {
            if (!skip_bad)
                throw std::runtime_error(std::string(error.what()) + " (--skip-bad leaves such frames out)");
            result.left_out.emplace_back(error.what());
            continue;
        }
        writer.addFile(dataset.entry(i).timestamp, depth, dataset.entry(i).image);
        result.written.push_back(i);
        progress.update(i + 1);
    }
    if (result.written.empty())
        throw std::runtime_error("no usable frame in " + dataset.description().folder);
    writer.finish();
    return result;
}

std::string groundTruthFileOf(const std::string& rawlog) {
    const std::filesystem::path path(rawlog);
    return (path.parent_path() / (path.stem().string() + "_groundtruth.txt")).string();
}

}  // namespace roevo
