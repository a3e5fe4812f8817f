#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "roevo/edge_map.h"

namespace roevo {

/// The vertices of a binary PLY file as roevo-odometry writes them.
class PlyFile {
  public:
    /// @throws std::runtime_error when it cannot be read, is of another kind, or is not whole
    explicit PlyFile(const std::string& path);

    std::size_t size() const { return size_; }
    const std::string& path() const { return path_; }

    /// Byte of a vertex at which a property begins.
    /// @param type  as the head of the file must have it, e.g. "float". @throws std::runtime_error
    std::size_t offsetOf(const std::string& property, const std::string& type) const;

    template <class Value>
    Value get(std::size_t vertex, std::size_t offset) const;

    /// The vertex's x, y and z. @throws std::runtime_error when they are not finite
    Eigen::Vector3f position(std::size_t vertex) const;
    Rgb colour(std::size_t vertex) const;

  private:
    struct Property {
        std::string type;
        std::size_t offset = 0;
    };

    std::size_t readHead();
    [[noreturn]] void fail(const std::string& what) const;

    std::string path_, bytes_;
    std::map<std::string, Property> properties_;
    std::size_t size_ = 0, stride_ = 0, begin_ = 0;
    std::size_t position_ = 0, colour_ = 0;  ///< where x and red begin
};

/// Edges from a map.ply. Keyframe and cluster are not in it. @throws std::runtime_error
EdgeMap readEdgesPly(const std::string& path);

/// Points from a map_semi_dense.ply. @throws std::runtime_error
std::vector<ColouredPoint> readPointsPly(const std::string& path);

}  // namespace roevo
