// The border to Python for pairs of boxes and triangles: packed arrays in, columns out.
#include "primitives.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>
#include <stdexcept>
#include <vector>

namespace nb = nanobind;
using namespace nb::literals;

namespace {

template <nb::ssize_t kColumns>
using Rows =
    nb::ndarray<const double, nb::numpy, nb::shape<-1, kColumns>, nb::c_contig, nb::device::cpu>;
using Shapes =
    nb::ndarray<const double, nb::numpy, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;
using Numbers = nb::ndarray<const double, nb::numpy, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
using Verdicts = nb::ndarray<std::uint8_t, nb::numpy, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

// One row for all pairs, or one for each of `count`.
template <typename Record, typename Array>
obb::Repeated<Record> repeated(const Array& array, std::size_t count) {
    if (array.shape(0) != 1 && array.shape(0) != count) {
        throw std::invalid_argument("arrays of pairs have different lengths");
    }
    if (reinterpret_cast<std::uintptr_t>(array.data()) % alignof(Record) != 0) {
        throw std::invalid_argument("array is not aligned");
    }
    return obb::Repeated<Record>({reinterpret_cast<const Record*>(array.data()), array.shape(0)});
}

obb::RepeatedMotion motion_of(const Rows<3>& velocity_a, const Rows<3>& velocity_b,
                              const Numbers& duration, std::size_t count) {
    return {repeated<obb::Vec3>(velocity_a, count), repeated<obb::Vec3>(velocity_b, count),
            repeated<double>(duration, count)};
}

// Calls `ask` with the shapes as what they are: a triangle's row has 9 numbers, a box's 15.
template <typename Ask>
auto with_shapes(const Shapes& a, const Shapes& b, std::size_t count, const Ask& ask) {
    constexpr std::size_t kTriangle = sizeof(obb::Triangle) / sizeof(double);
    constexpr std::size_t kObb = sizeof(obb::Obb) / sizeof(double);
    static_assert(kTriangle == 9 && kObb == 15);
    const auto is_row = [](const Shapes& s) {
        return s.shape(1) == kTriangle || s.shape(1) == kObb;
    };
    if (!is_row(a) || !is_row(b)) {
        throw std::invalid_argument("a shape's row has 9 or 15 numbers");
    }
    const auto with_b = [&](const auto& first) {
        return b.shape(1) == kObb ? ask(first, repeated<obb::Obb>(b, count))
                                  : ask(first, repeated<obb::Triangle>(b, count));
    };
    return a.shape(1) == kObb ? with_b(repeated<obb::Obb>(a, count))
                              : with_b(repeated<obb::Triangle>(a, count));
}

void intersects(const Shapes& a, const Shapes& b, const Rows<3>& velocity_a,
                const Rows<3>& velocity_b, const Numbers& duration, unsigned threads,
                const Verdicts& verdicts) {
    const std::size_t count = verdicts.shape(0);
    const obb::RepeatedMotion motion = motion_of(velocity_a, velocity_b, duration, count);
    with_shapes(a, b, count, [&](const auto& first, const auto& second) {
        nb::gil_scoped_release release;
        obb::test_pairs(first, second, motion, threads, {verdicts.data(), count});
    });
}

// One column of the result: `Width` numbers for each contact.
template <std::size_t Width, typename T, typename Source, typename Get>
nb::object column(const std::vector<Source>& source, const Get& get) {
    auto* values = new std::vector<T>;
    nb::capsule owner(values, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    values->reserve(Width * source.size());
    for (const Source& item : source) {
        get(item, *values);
    }
    if constexpr (Width == 1) {
        return nb::cast(nb::ndarray<nb::numpy, T>(values->data(), {source.size()}, owner));
    } else {
        return nb::cast(nb::ndarray<nb::numpy, T>(values->data(), {source.size(), Width}, owner));
    }
}

nb::object vectors(const std::vector<obb::PairContact>& contacts,
                   obb::Vec3 (*get)(const obb::PairContact&)) {
    return column<3, double>(contacts, [get](const auto& contact, auto& out) {
        const obb::Vec3 v = get(contact);
        out.insert(out.end(), {v.x, v.y, v.z});
    });
}

nb::object scalars(const std::vector<obb::PairContact>& contacts,
                   double (*get)(const obb::PairContact&)) {
    return column<1, double>(
        contacts, [get](const auto& contact, auto& out) { out.push_back(get(contact)); });
}

nb::object codes(const std::vector<obb::PairContact>& contacts) {
    return column<7, std::int8_t>(contacts, [](const obb::PairContact& c, auto& out) {
        const obb::Touch& t = c.touch;
        const auto code = [](auto value) { return static_cast<std::int8_t>(value); };
        out.insert(out.end(),
                   {code(t.axis.kind), code(t.axis.a), code(t.axis.b), t.side,
                    code(t.feature_a.dimension), code(t.feature_b.dimension), code(c.ends)});
    });
}

nb::dict first_contacts(const Shapes& a, const Shapes& b, const Rows<3>& velocity_a,
                        const Rows<3>& velocity_b, const Numbers& duration, std::size_t count,
                        unsigned threads) {
    using obb::PairContact;
    const obb::RepeatedMotion motion = motion_of(velocity_a, velocity_b, duration, count);
    const obb::PairContacts found =
        with_shapes(a, b, count, [&](const auto& first, const auto& second) {
            nb::gil_scoped_release release;
            return obb::first_contacts(first, second, motion, count, threads);
        });
    const std::vector<PairContact>& c = found.contacts;
    nb::dict columns;
    columns["rows"] = column<1, std::int64_t>(
        found.rows, [](std::int64_t row, auto& out) { out.push_back(row); });
    columns["time"] = scalars(c, [](const PairContact& x) { return x.time; });
    columns["time_below"] = scalars(c, [](const PairContact& x) { return x.time_below; });
    columns["last_time"] = scalars(c, [](const PairContact& x) { return x.last_time; });
    columns["codes"] = codes(c);
    columns["axis"] = vectors(c, [](const PairContact& x) { return x.touch.normal; });
    columns["point"] = vectors(c, [](const PairContact& x) { return x.point; });
    columns["normal_a"] = vectors(c, [](const PairContact& x) { return x.normal_a; });
    columns["normal_b"] = vectors(c, [](const PairContact& x) { return x.normal_b; });
    columns["smooth_normal_a"] = vectors(c, [](const PairContact& x) { return x.smooth_normal_a; });
    columns["smooth_normal_b"] = vectors(c, [](const PairContact& x) { return x.smooth_normal_b; });
    return columns;
}

} // namespace

void bind_primitives(nb::module_& m) {
    m.def("primitive_intersects", &intersects, "a"_a, "b"_a, "velocity_a"_a, "velocity_b"_a,
          "duration"_a, "threads"_a, "verdicts"_a);
    m.def("primitive_first_contacts", &first_contacts, "a"_a, "b"_a, "velocity_a"_a, "velocity_b"_a,
          "duration"_a, "count"_a, "threads"_a);
}
