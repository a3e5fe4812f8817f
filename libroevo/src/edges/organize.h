#pragma once
#include <cstdint>
#include <vector>

#include "edges/canny.h"
#include "edges/organized_edges.h"

namespace roevo {

/// Removes the two pixel patterns in which a breadth-first search has more than one route: a pixel with edge
/// neighbours on three of its four sides (T), and the corner of an L. Afterwards no 2x2 block holds more than
/// two edge pixels, so neighbours of a pixel are never neighbours of each other and every pixel is reached by
/// one route. Changes mask and pixels.
void adjustAdjacency(EdgeMask& edges);

/// Turns an adjusted edge mask into organized edges: oriented breadth-first search (neighbours whose
/// gradients differ by less than `angle_deg` are one cluster), then the longest pair of non-intersecting
/// routes of the search tree, put in order. Routes shorter than `min_length` pixels are dropped; branches
/// that the longest pair leaves out are searched once more as edges of their own.
class EdgeOrganizer {
  public:
    void organize(const Gradient& gradient, const EdgeMask& edges, double angle_deg, int min_length,
                  OrganizedEdges& out);

  private:
    struct Node {
        std::int32_t pixel, parent;
        std::int32_t depth1, depth2;  ///< lengths of the two longest routes below this node, in nodes
        std::int32_t child1, child2;  ///< where they begin
        unsigned parent_bit;          ///< of its neighbourhood
    };
    void growCluster(const Gradient& gradient, const std::uint8_t* mask, std::int32_t seed, float min_cosine);
    /// Appends the pixels of the longest pair of routes, in order. @return how many
    std::size_t appendLongestRoute();
    void searchFrom(const Gradient& gradient, const std::uint8_t* mask, std::int32_t seed, float min_cosine,
                    std::size_t min_length, std::vector<std::int32_t>& begin);

    std::vector<std::uint8_t> open_;  ///< 1 where an edge pixel waits to be visited; all 0 between calls
    std::vector<Node> tree_;          ///< room for all pixels
    std::size_t nodes_ = 0;           ///< of them in use
    std::vector<std::int32_t> again_;
    std::vector<std::int32_t> points_;  ///< pixels of the edges found, one edge after the other
    int width_ = 0;
};

}  // namespace roevo
