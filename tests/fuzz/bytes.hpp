// What a fuzzer's bytes say, read from the front; whatever is missing is zero.
#pragma once

#include "shapes/pose.hpp"
#include "shapes/screw.hpp"
#include "tree/tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

namespace fuzz {

// A broken promise ends the process, whatever the sanitizers think of it.
inline void require(bool holds, const char* promise) {
    if (!holds) {
        std::fprintf(stderr, "broken: %s\n", promise);
        std::abort();
    }
}

class Bytes {
  public:
    Bytes(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}

    template <typename T>
    [[nodiscard]] T take() {
        T value{};
        const std::size_t count = std::min(sizeof(T), rest_.size());
        std::memcpy(&value, rest_.data(), count);
        rest_ = rest_.subspan(count);
        return value;
    }
    [[nodiscard]] std::uint32_t below(std::uint32_t limit) { return take<std::uint8_t>() % limit; }
    [[nodiscard]] std::span<const std::uint8_t> rest() const { return rest_; }

    // Any finite double; on a grid, whole numbers that meet each other often.
    [[nodiscard]] double number(bool on_grid) {
        if (on_grid) {
            return take<std::int8_t>() / 8;
        }
        const double value = take<double>();
        return std::isfinite(value) ? value : 0;
    }
    // Of moderate size.
    [[nodiscard]] double moderate() { return take<std::int16_t>() / 1024.0; }

    [[nodiscard]] obb::Vec3 point(bool on_grid) {
        const double x = number(on_grid), y = number(on_grid);
        return {x, y, number(on_grid)};
    }
    [[nodiscard]] obb::Vec3 moderate_point() {
        const double x = moderate(), y = moderate();
        return {x, y, moderate()};
    }
    [[nodiscard]] obb::Triangle triangle(bool on_grid) {
        const obb::Vec3 p = point(on_grid), q = point(on_grid);
        return {p, q, point(on_grid)};
    }

    // By a quaternion of any length, or none.
    [[nodiscard]] obb::Mat3 rotation() {
        const auto w = take<std::int8_t>(), x = take<std::int8_t>(), y = take<std::int8_t>(),
                   z = take<std::int8_t>();
        if (w * w + x * x + y * y + z * z == 0) {
            return obb::Mat3::identity();
        }
        const auto rows = obb::axes_of_quaternion<double>(w, x, y, z);
        return {{rows[0], rows[1], rows[2]}};
    }
    [[nodiscard]] obb::Pose pose() {
        const obb::Mat3 turned = rotation();
        return {turned, moderate_point()};
    }
    [[nodiscard]] obb::Screw screw() {
        const obb::Vec3 v = moderate_point(), w = moderate_point();
        return {v, w, moderate_point()};
    }

  private:
    std::span<const std::uint8_t> rest_;
};

} // namespace fuzz
