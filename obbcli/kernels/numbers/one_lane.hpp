// What lanes are asked, of a single number: formulas that are written once run on both.
#pragma once

#include <cmath>

namespace obb {

[[nodiscard]] inline double root_of(double a) { return std::sqrt(a); }
[[nodiscard]] inline double select(bool mask, double a, double b) { return mask ? a : b; }

} // namespace obb
