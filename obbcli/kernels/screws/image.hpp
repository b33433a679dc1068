// Images of triangles in coordinates about a screw axis: the radius r, the angle theta, the height
// z, and u = z - pitch * theta, which no screw of that pitch changes.
#pragma once

#include "screws/relative_screw.hpp"
#include "shapes/triangle.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace obb {

struct Span {
    double low, high;

    [[nodiscard]] double middle() const { return 0.5 * low + 0.5 * high; }
    [[nodiscard]] double length() const { return high - low; }
    void hold(const Span& other) {
        low = other.low < low ? other.low : low;
        high = other.high > high ? other.high : high;
    }
};

// A point about the axis. The angle is in (-pi, pi], off by 2^-45 at most; NaN where there is none.
struct AxialPoint {
    double x, y, z; // along across, third and axis
    double radius, angle;
};

[[nodiscard]] AxialPoint axial_point(double x, double y, double z);
// Of a position about its body's pivot; `shift` is that of its body.
[[nodiscard]] AxialPoint axial_point(const RelativeScrew& screw, Vec3 position, Vec3 shift);

// What holds a triangle, or a piece of one, wherever its points truly are within the slack. All
// turns of the image by 2 pi are images of it too; which one is stored does not matter.
struct Image {
    Span radius, height, angle;
    // In the plane of r and u it lies in the hull of three corners, widened by [-sag_r, 0] in r, by
    // sag_u in u either way, and then by a disc of radius `round`. In the plane of r and z, its
    // profile, it lies in the hull of three corners, widened by [-sag_r, 0] in r and by the slack.
    std::array<double, 3> r, u, z;
    double sag_r, sag_u, round;
    std::uint32_t triangle; // as its body's owner numbers them
    // It is too near the axis to have an angle: its profile alone bounds it, and stands for u too.
    bool is_ring;
    bool is_piece; // it holds a part of the triangle only

    // Where it lies along (n_r, n_u), or its profile along (n_r, n_z), of length 1 to 4 u.
    [[nodiscard]] Span along(double n_r, double n_u) const;
    [[nodiscard]] Span profile_along(double n_r, double n_z, double slack) const;
};

// Makes the images of one body's triangles.
class ImageMaker {
  public:
    // Angles are shifted by whole turns so that u is within one lead above `base`, if the body is
    // not too many leads high for that.
    ImageMaker(const RelativeScrew& screw, double base, double extent);

    // Appends the image of a triangle, or of its pieces where it spans too wide an angle.
    void add(const std::array<AxialPoint, 3>& corners, std::uint32_t triangle,
             std::vector<Image>& images) const;

  private:
    void cut(const std::array<AxialPoint, 3>& corners, unsigned depth, Image& image,
             std::vector<Image>& images) const;
    [[nodiscard]] bool set(const std::array<AxialPoint, 3>& corners, Image& image) const;
    void set_ring(const std::array<AxialPoint, 3>& corners, Image& image) const;

    double pitch_, lead_, slack_, base_;
    bool is_shifted_;
};

} // namespace obb
