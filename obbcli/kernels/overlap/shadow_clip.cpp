#include "overlap/shadow_clip.hpp"

#include <algorithm>

namespace obb {

ShadowClip::ShadowClip(const Shadow& subject, const Shadow& other)
    : subject_(subject), other_(other), unit_(kUnitRoundoff * (subject.extent + other.extent)) {
    for (std::size_t k = 0; k < 3; ++k) {
        subject_u[k] = subject.u[k] - subject.u[0];
        subject_v[k] = subject.v[k] - subject.v[0];
        other_u[k] = other.u[k] - subject.u[0];
        other_v[k] = other.v[k] - subject.v[0];
    }
}

ShadowClip::Edge ShadowClip::edge_of(const Shadow& shadow, const std::array<double, 3>& u,
                                     const std::array<double, 3>& v, std::size_t k) const {
    return {u[k], v[k], shadow.along_u[k], shadow.along_v[k], unit_ * shadow.along_sum[k]};
}

// 4.01 u D for the value and 2 u D for how far the corners of both moved; 8 is more than enough.
// Corners that the triangles share lie on the edges that end there.
bool ShadowClip::is_beyond_edge(const Shadow& shadow, const std::array<double, 3>& u,
                                const std::array<double, 3>& v, const Shadow& theirs,
                                const std::array<double, 3>& their_u,
                                const std::array<double, 3>& their_v) const {
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = k == 2 ? 0 : k + 1;
        const Edge e = edge_of(shadow, u, v, k);
        bool is_beyond = true;
        for (std::size_t i = 0; i < 3 && is_beyond; ++i) {
            const auto is_end = [&](std::size_t end) {
                return shadow.u[end] == theirs.u[i] && shadow.v[end] == theirs.v[i];
            };
            is_beyond = side(e, their_u[i], their_v[i]) < -8 * e.doubt || is_end(k) || is_end(next);
        }
        if (is_beyond) {
            return true;
        }
    }
    return false;
}

bool ShadowClip::are_apart() const {
    return is_beyond_edge(other_, other_u, other_v, subject_, subject_u, subject_v) ||
           is_beyond_edge(subject_, subject_u, subject_v, other_, other_u, other_v);
}

void ShadowClip::cut(const ColumnWindow& window) {
    kept_.count = 3;
    std::copy(subject_u.begin(), subject_u.end(), kept_.u.begin());
    std::copy(subject_v.begin(), subject_v.end(), kept_.v.begin());
    kept_.slack = 12;
    std::array<double, ClippedShadow::kMost> sides{};
    for (std::size_t k = 0; k < 3 && kept_.count > 0; ++k) {
        const Edge e = edge_of(other_, other_u, other_v, k);
        for (std::size_t i = 0; i < kept_.count; ++i) {
            sides[i] = side(e, kept_.u[i], kept_.v[i]);
        }
        cut_along(sides, 6 * e.doubt);
    }
    // A side of the window matters only where both triangles go beyond it.
    const auto lower = [](double a, double b) { return a < b ? b : a; };
    const auto upper = [](double a, double b) { return a < b ? a : b; };
    if (lower(subject_.low_u, other_.low_u) < window.low[0]) {
        cut_at(window.low[0], true, true);
    }
    if (upper(subject_.high_u, other_.high_u) > window.high[0]) {
        cut_at(window.high[0], true, false);
    }
    if (lower(subject_.low_v, other_.low_v) < window.low[1]) {
        cut_at(window.low[1], false, true);
    }
    if (upper(subject_.high_v, other_.high_v) > window.high[1]) {
        cut_at(window.high[1], false, false);
    }
}

void ShadowClip::cut_at(double limit, bool is_u, bool is_low) {
    const double place = limit - (is_u ? subject_.u[0] : subject_.v[0]);
    std::array<double, ClippedShadow::kMost> sides{};
    for (std::size_t i = 0; i < kept_.count; ++i) {
        const double beyond = (is_u ? kept_.u[i] : kept_.v[i]) - place;
        sides[i] = is_low ? beyond : -beyond;
    }
    cut_along(sides, 3 * unit_);
}

void ShadowClip::cut_along(const std::array<double, ClippedShadow::kMost>& sides, double doubt) {
    const std::size_t n = kept_.count;
    double least = sides[0];
    for (std::size_t i = 1; i < n; ++i) {
        least = std::min(least, sides[i]);
    }
    if (n == 0 || least >= doubt) {
        return;
    }
    kept_.slack += 8 * static_cast<double>(n);
    if (least >= 0) {
        return;
    }
    ClippedShadow cut;
    const auto push = [&](double u, double v) {
        if (cut.count == ClippedShadow::kMost) {
            kept_.is_too_large = true;
            return;
        }
        cut.u[cut.count] = u;
        cut.v[cut.count] = v;
        ++cut.count;
    };
    for (std::size_t i = 0, j = n - 1; i < n; j = i++) {
        const bool is_inside = sides[i] >= 0;
        if (is_inside != (sides[j] >= 0)) {
            const double t = sides[j] / (sides[j] - sides[i]);
            push(kept_.u[j] + t * (kept_.u[i] - kept_.u[j]),
                 kept_.v[j] + t * (kept_.v[i] - kept_.v[j]));
            kept_.slack += 6;
        }
        if (is_inside) {
            push(kept_.u[i], kept_.v[i]);
        }
    }
    kept_.u = cut.u;
    kept_.v = cut.v;
    kept_.count = cut.count;
}

} // namespace obb
