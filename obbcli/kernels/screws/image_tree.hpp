// A tree over the images of one body, made as it is used. Neighbours on a thread are far apart in
// it: a flank, with all its turns, has one u, and so one node.
#pragma once

#include "screws/image.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace obb {

// In the plane of r and u: what lies within e1 of the centre along the axis (n_r, n_u), and within
// e2 along (-n_u, n_r). The axis has length 1 to 4 u.
struct Rectangle {
    double r = 0, u = 0;
    double n_r = 1, n_u = 0;
    double e1 = 0, e2 = 0;
};

// A range of images. Rings have nodes of their own, so that they spoil no other; the rectangle of
// those is in the plane of r and z.
struct ImageNode {
    Span radius, height, angle;
    Rectangle rectangle;
    double size; // by which the larger node of a pair is opened
    std::uint32_t begin, end;
    std::uint32_t children; // number of the first of two; 0 before it is split
    bool is_ring;

    // The one image of a node that is not split any further. No split moves it any more.
    [[nodiscard]] bool is_image() const { return end - begin == 1; }
};

class ImageTree {
  public:
    ImageTree() = default;
    ImageTree(const RelativeScrew& screw, std::vector<Image> images);

    // Numbers of the nodes that hold all images between them: one or two, or none.
    [[nodiscard]] const std::vector<std::uint32_t>& roots() const { return roots_; }
    [[nodiscard]] const ImageNode& node(std::uint32_t number) const { return nodes_[number]; }
    [[nodiscard]] std::size_t image_count() const { return images_.size(); }
    [[nodiscard]] const Image& image(std::uint32_t number) const { return images_[number]; }
    // The number of the first of a node's two children, made now if need be. Of no single image.
    [[nodiscard]] std::uint32_t split(std::uint32_t number);

  private:
    void add_root(std::uint32_t begin, std::uint32_t end);
    [[nodiscard]] ImageNode node_of(std::uint32_t begin, std::uint32_t end) const;
    [[nodiscard]] std::uint32_t part(const ImageNode& node);
    template <typename Key>
    [[nodiscard]] std::uint32_t part_by(const ImageNode& node, const Key& key);
    [[nodiscard]] double angular_length(const ImageNode& node) const;

    std::vector<Image> images_;
    std::vector<ImageNode> nodes_;
    std::vector<std::uint32_t> roots_;
    double pitch_ = 0, sweep_ = 0;
};

} // namespace obb
