#include "screws/image_tree.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace obb {

namespace {

// To separate for ever takes nodes small in r and u, to find out when takes nodes small in angle:
// the angle counts as much as the motion is short, and as the screw is steep, for then u goes with
// the angle; but this much at least.
constexpr double kLeastWeight = 1.0 / 8;
// A split that leaves one side less than this share is made at the median instead.
constexpr std::uint32_t kLeastShare = 32;

struct Direction {
    double r, u;
};

Direction unit_or_r(double r, double u) {
    const double length = std::sqrt(r * r + u * u);
    const bool is_usable = length > 0x1p-400 && length < 0x1p400; // squares are normal; no NaN
    return is_usable ? Direction{r / length, u / length} : Direction{1, 0};
}

// Along the longest edge of a triangle's image.
Direction longest_edge(const Image& image) {
    double most = -1, dr = 0, du = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double r = image.r[(k + 1) % 3] - image.r[k], u = image.u[(k + 1) % 3] - image.u[k];
        if (r * r + u * u > most) {
            most = r * r + u * u;
            dr = r;
            du = u;
        }
    }
    return unit_or_r(dr, du);
}

// Along which corners vary most: half the angle of (c_rr - c_uu, 2 c_ru), c their covariance.
Direction principal(std::span<const Image> images) {
    double r = 0, u = 0;
    for (const Image& image : images) {
        r += image.r[0] + image.r[1] + image.r[2];
        u += image.u[0] + image.u[1] + image.u[2];
    }
    const double count = 3 * static_cast<double>(images.size());
    r /= count;
    u /= count;
    double rr = 0, ru = 0, uu = 0;
    for (const Image& image : images) {
        for (std::size_t k = 0; k < 3; ++k) {
            const double x = image.r[k] - r, y = image.u[k] - u;
            rr += x * x;
            ru += x * y;
            uu += y * y;
        }
    }
    const Direction twice = unit_or_r(0.5 * (rr - uu), ru);
    const double cosine = std::sqrt(std::max(0.0, 0.5 + 0.5 * twice.r)),
                 sine = std::sqrt(std::max(0.0, 0.5 - 0.5 * twice.r));
    return unit_or_r(cosine, twice.u < 0 ? -sine : sine);
}

// Holds the images whatever the direction. The middles are rounded to the centre that is stored,
// whose own coordinates the extents are taken from: they err by 4 u of the sizes in play. Points
// are c + x n + y n' only up to the length of n, 4 u: hence the factor.
Rectangle fitted(std::span<const Image> images) {
    const Direction n = images.size() == 1 ? longest_edge(images[0]) : principal(images);
    Span first = images[0].along(n.r, n.u), second = images[0].along(-n.u, n.r);
    for (const Image& image : images.subspan(1)) {
        first.hold(image.along(n.r, n.u));
        second.hold(image.along(-n.u, n.r));
    }
    Rectangle box{};
    box.n_r = n.r;
    box.n_u = n.u;
    box.r = n.r * first.middle() - n.u * second.middle();
    box.u = n.u * first.middle() + n.r * second.middle();
    const auto extent = [&](const Span& span, double at) {
        const double sizes =
            std::fabs(span.low) + std::fabs(span.high) + std::fabs(box.r) + std::fabs(box.u);
        return (1 + 0x1p-48) * std::max(span.high - at, at - span.low) + 0x1p-49 * sizes;
    };
    box.e1 = extent(first, n.r * box.r + n.u * box.u);
    box.e2 = extent(second, n.r * box.u - n.u * box.r);
    return box;
}

} // namespace

ImageTree::ImageTree(const RelativeScrew& screw, std::vector<Image> images)
    : images_(std::move(images)), pitch_(screw.pitch), sweep_(screw.sweep) {
    const auto rings = std::partition(images_.begin(), images_.end(),
                                      [](const Image& image) { return !image.is_ring; });
    const auto middle = static_cast<std::uint32_t>(rings - images_.begin());
    nodes_.emplace_back(); // number 0 says that there is no child
    add_root(0, middle);
    add_root(middle, static_cast<std::uint32_t>(images_.size()));
}

void ImageTree::add_root(std::uint32_t begin, std::uint32_t end) {
    if (begin < end) {
        roots_.push_back(static_cast<std::uint32_t>(nodes_.size()));
        nodes_.push_back(node_of(begin, end));
    }
}

// Half the way of the node's points along the screw, as far as it tells when they meet.
double ImageTree::angular_length(const ImageNode& node) const {
    if (node.is_ring) {
        return 0;
    }
    const double r = node.radius.high;
    const double way = std::sqrt(r * r + pitch_ * pitch_); // of one radian
    const double longer = std::max(node.rectangle.e1, node.rectangle.e2);
    const double steep = std::fabs(pitch_) / (std::fabs(pitch_) + r);
    const double weight = std::max({kLeastWeight, steep, longer / (longer + way * sweep_)});
    return 0.5 * node.angle.length() * way * weight;
}

ImageNode ImageTree::node_of(std::uint32_t begin, std::uint32_t end) const {
    const std::span<const Image> images{images_.data() + begin, end - begin};
    ImageNode node{};
    node.begin = begin;
    node.end = end;
    node.radius = images[0].radius;
    node.height = images[0].height;
    node.angle = images[0].angle;
    for (const Image& image : images.subspan(1)) {
        node.radius.hold(image.radius);
        node.height.hold(image.height);
        node.angle.hold(image.angle);
    }
    node.is_ring = images[0].is_ring;
    node.rectangle = fitted(images);
    node.size = std::max({node.rectangle.e1, node.rectangle.e2, angular_length(node)});
    return node;
}

std::uint32_t ImageTree::split(std::uint32_t number) {
    if (nodes_[number].children == 0) {
        const ImageNode node = nodes_[number];
        const std::uint32_t middle = part(node);
        const auto first = static_cast<std::uint32_t>(nodes_.size());
        const ImageNode left = node_of(node.begin, middle), right = node_of(middle, node.end);
        nodes_.push_back(left);
        nodes_.push_back(right);
        nodes_[number].children = first;
    }
    return nodes_[number].children;
}

// Where its images' middles are furthest apart.
std::uint32_t ImageTree::part(const ImageNode& node) {
    const Rectangle& box = node.rectangle;
    if (angular_length(node) > std::max(box.e1, box.e2)) {
        return part_by(node, [](const Image& image) { return image.angle.middle(); });
    }
    const bool is_first = box.e1 >= box.e2;
    const double n_r = is_first ? box.n_r : -box.n_u, n_u = is_first ? box.n_u : box.n_r;
    return part_by(node, [=](const Image& image) { return image.along(n_r, n_u).middle(); });
}

// At the middle between the outermost keys, or at the median; both halves hold something.
template <typename Key>
std::uint32_t ImageTree::part_by(const ImageNode& node, const Key& key) {
    const auto begin = images_.begin() + node.begin, end = images_.begin() + node.end;
    Span keys{key(*begin), key(*begin)};
    for (auto image = begin; image != end; ++image) {
        const double k = key(*image);
        keys.hold({k, k});
    }
    const double at = keys.middle();
    auto middle = std::partition(begin, end, [&](const Image& image) { return key(image) < at; });
    const std::uint32_t count = node.end - node.begin;
    const auto left = static_cast<std::uint32_t>(middle - begin);
    if (left == 0 || left == count || std::min(left, count - left) < count / kLeastShare) {
        middle = begin + count / 2;
        std::nth_element(begin, middle, end,
                         [&](const Image& x, const Image& y) { return key(x) < key(y); });
    }
    return static_cast<std::uint32_t>(middle - images_.begin());
}

} // namespace obb
