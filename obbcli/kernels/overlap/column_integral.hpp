// The integral of the lower of two heights over a triangle, above the floor.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace obb {

// A place of the plane, and how high two surfaces are there.
struct ColumnPlace {
    double u, v;
    double first, second;
};

// Sums of max(0, min(first, second)) over triangles, with both heights linear on each; the areas of
// triangles that turn clockwise count as negative.
class ColumnIntegral {
  public:
    double volume = 0;
    std::array<double, 3> moments{0, 0, 0};
    double area = 0; // of all, none negative

    void add(const ColumnPlace& a, const ColumnPlace& b, const ColumnPlace& c) {
        area += 0.5 * std::fabs(twice_area(a, b, c));
        const double x = a.first - a.second, y = b.first - b.second, z = c.first - c.second;
        if ((x <= 0 && y <= 0 && z <= 0) || (x >= 0 && y >= 0 && z >= 0)) {
            add_above_floor(lower(a), lower(b), lower(c));
        } else if ((x > 0) != (y > 0) && (x > 0) != (z > 0)) {
            add_crossing(a, b, c, x, y, z);
        } else if ((y > 0) != (z > 0) && (y > 0) != (x > 0)) {
            add_crossing(b, c, a, y, z, x);
        } else {
            add_crossing(c, a, b, z, x, y);
        }
    }

  private:
    struct Place {
        double u, v, h;
    };
    static double twice_area(const auto& a, const auto& b, const auto& c) {
        return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
    }
    static Place lower(const ColumnPlace& p) {
        return {p.u, p.v, p.first < p.second ? p.first : p.second};
    }
    // Where the heights cross between two places whose differences are x and y.
    static Place crossing(const ColumnPlace& a, const ColumnPlace& b, double x, double y) {
        const double t = x / (x - y);
        const double first = a.first + t * (b.first - a.first);
        const double second = a.second + t * (b.second - a.second);
        return {a.u + t * (b.u - a.u), a.v + t * (b.v - a.v), first < second ? first : second};
    }
    // The first place is on one side of where the heights cross, the others on the other.
    void add_crossing(const ColumnPlace& a, const ColumnPlace& b, const ColumnPlace& c, double x,
                      double y, double z) {
        const Place ab = crossing(a, b, x, y), ac = crossing(a, c, x, z);
        add_above_floor(lower(a), ab, ac);
        add_above_floor(ab, lower(b), lower(c));
        add_above_floor(ab, lower(c), ac);
    }
    static Place on_floor(const Place& a, const Place& b) {
        const double t = a.h / (a.h - b.h);
        return {a.u + t * (b.u - a.u), a.v + t * (b.v - a.v), 0};
    }
    void add_above_floor(const Place& a, const Place& b, const Place& c) {
        const bool above[3] = {a.h > 0, b.h > 0, c.h > 0};
        const int count = above[0] + above[1] + above[2];
        if (count == 3 || (a.h >= 0 && b.h >= 0 && c.h >= 0)) {
            add_prism(a, b, c);
        } else if (count == 1) {
            above[0]   ? add_prism(a, on_floor(a, b), on_floor(a, c))
            : above[1] ? add_prism(b, on_floor(b, c), on_floor(b, a))
                       : add_prism(c, on_floor(c, a), on_floor(c, b));
        } else if (count == 2) {
            !above[0]   ? add_quad(b, c, on_floor(c, a), on_floor(b, a))
            : !above[1] ? add_quad(c, a, on_floor(a, b), on_floor(c, b))
                        : add_quad(a, b, on_floor(b, c), on_floor(a, c));
        }
    }
    void add_quad(const Place& a, const Place& b, const Place& c, const Place& d) {
        add_prism(a, b, c);
        add_prism(a, c, d);
    }
    void add_prism(const Place& a, const Place& b, const Place& c) {
        const double twelfth = twice_area(a, b, c) * (1.0 / 24);
        const double sum = a.h + b.h + c.h;
        volume += 4 * (twelfth * sum);
        moments[0] += twelfth * ((a.u + b.u + c.u) * sum + (a.u * a.h + b.u * b.h + c.u * c.h));
        moments[1] += twelfth * ((a.v + b.v + c.v) * sum + (a.v * a.h + b.v * b.h + c.v * c.h));
        moments[2] += 0.5 * twelfth * (sum * sum + (a.h * a.h + b.h * b.h + c.h * c.h));
    }
};

} // namespace obb
